#include "bench/bench_interpolation.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/base/files/json.h"
#include "core/orbit/catalogue_interpolation.h"
#include "core/orbit/elements/catalogue.h"
#include "core/orbit/elements/epoch.h"
#include "core/orbit/sgp4/synthetic_catalogue.h"

namespace dmise {
namespace {

std::vector<MeanElements> catalogue() {
  if (const char* root = std::getenv("DMISE_DATA"))
    return read_catalogue(std::string(root) + "/tle/catalog_3le_2019-12-19_18470.txt.gz").elements;
  return synthetic_catalogue({.objects = 18470, .seed = 1});
}

/// Median of the epochs: most elements are then at most a day old.
Utc median_epoch(const std::vector<MeanElements>& elements) {
  std::vector<Utc> epochs;
  for (const auto& e : elements) epochs.push_back({e.epoch_jd1, e.epoch_jd2});
  const auto middle = epochs.begin() + static_cast<std::ptrdiff_t>(epochs.size() / 2);
  std::nth_element(epochs.begin(), middle, epochs.end(), [](const Utc& a, const Utc& b) {
    return a.jd1 != b.jd1 ? a.jd1 < b.jd1 : a.jd2 < b.jd2;
  });
  return *middle;
}

/// Time to interpolate the positions of one object [ns]: median of repeats over the whole
/// catalogue.
double cost_ns(HermiteOrder order, std::size_t objects) {
  const std::size_t size = 3 * objects;
  std::vector<std::vector<double>> positions(4, std::vector<double>(size, 7e6));
  std::vector<std::vector<double>> slopes(4, std::vector<double>(size, 7e3));
  std::vector<double> out(size), times;
  for (int repeat = 0; repeat < 15; ++repeat) {
    const HermiteWeights w = hermite_weights(order, 0.1 + 0.05 * repeat, 10.0);
    const auto begin = std::chrono::steady_clock::now();
    std::fill(out.begin(), out.end(), 0.0);
    for (std::size_t k = 0; k < static_cast<std::size_t>(w.count); ++k) {
      const double *p = positions[k].data(), *s = slopes[k].data();
      for (std::size_t j = 0; j < size; ++j) out[j] += p[j] * w.position[k] + s[j] * w.slope_s[k];
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    times.push_back(took.count() * 1e9 / static_cast<double>(objects));
    if (out[size / 2] == 0.0) return 0.0;  // uses the result
  }
  std::nth_element(times.begin(), times.begin() + 7, times.end());
  return times[7];
}

}  // namespace

int bench_interpolation(bool json) {
  const std::vector<MeanElements> elements = catalogue();
  const Sgp4Batch batch(elements);
  const Utc start = median_epoch(elements);
  const auto line = [&](const std::string& name, double value, const char* unit) {
    JsonWriter out;
    out.begin_object().field("name", name.c_str()).field("value", value).field("unit", unit);
    std::puts(out.end_object().text().c_str());
  };
  if (!json)
    std::printf(
        "%zu objects from %s UTC on; greatest error of each over four whole ticks\n%6s %5s %12s "
        "%12s %12s %10s\n",
        elements.size(), format_iso_epoch(start).c_str(), "tick s", "order", "median mm", "99 % mm",
        "max mm", "ns/object");
  for (const HermiteOrder order :
       {HermiteOrder::cubic, HermiteOrder::quintic, HermiteOrder::septic}) {
    const double ns = cost_ns(order, elements.size());
    for (const double tick_s : {5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 180.0, 240.0, 300.0}) {
      const auto error =
          measure_catalogue_interpolation(batch, start, {.order = order, .tick_s = tick_s});
      std::vector<double> mm;
      for (std::size_t i = 0; i < elements.size(); ++i)
        if (error.code[i] == 0) mm.push_back(error.max_m[i] * 1e3);
      if (mm.empty()) return 1;
      std::sort(mm.begin(), mm.end());
      const double median = mm[mm.size() / 2], high = mm[mm.size() * 99 / 100], worst = mm.back();
      if (json) {
        const std::string name = "interpolation_order" + std::to_string(static_cast<int>(order)) +
                                 "_" + std::to_string(static_cast<int>(tick_s)) + "s_";
        line(name + "median_mm", median, "mm");
        line(name + "p99_mm", high, "mm");
        line(name + "max_mm", worst, "mm");
        line(name + "cost_ns", ns, "ns");
      } else {
        std::printf("%6.0f %5d %12.4f %12.4f %12.3f %10.2f\n", tick_s, static_cast<int>(order),
                    median, high, worst, ns);
      }
    }
  }
  return 0;
}

}  // namespace dmise
