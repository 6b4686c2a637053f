#include "bench/bench_sgp4.h"

#include <stdlib.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/sgp4_scale.h"
#include "bench/timing.h"
#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/orbit/cones/cone_test.h"
#include "core/orbit/elements/element_text.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/orbit/sgp4/synthetic_catalogue.h"
#include "tests/support/tle.h"

namespace dmise {
namespace {

struct Outputs {
  std::vector<double> position, velocity;
  std::vector<std::uint8_t> code;
  explicit Outputs(std::size_t n) : position(3 * n), velocity(3 * n), code(n) {}
};

/// Millions of states per second of one thread: a whole catalogue at `times` ticks of 10 s per
/// call, in the given order.
double states_m_per_s(const std::vector<MeanElements>& elements, SimdLevel simd, double jd1,
                      std::size_t times) {
  const Sgp4Batch batch(elements, nullptr, simd);
  Outputs out(batch.size() * times);
  std::vector<Utc> ticks(times);
  const auto propagate = [&](int call) {
    for (std::size_t k = 0; k < times; ++k)
      ticks[k] = {jd1, 10.0 / 86400.0 * double(std::size_t(call) * times + k)};
    batch.propagate(ticks, out.position, out.velocity, out.code);
  };
  propagate(0);
  const double s = median_seconds(times == 1 ? 101 : 25, propagate);
  return double(batch.size() * times) / s * 1e-6;
}

template <class T>
std::vector<T> read_values(const std::string& path) {
  const std::string bytes = read_text_file(path);
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

struct Agreement {
  double worst_km = 0.0;
  int mismatches = 0;
  std::size_t states = 0;
};

/// Compares with the states of the anchor: object by object at its own times.
void compare(const std::vector<MeanElements>& elements, const std::string& stem, int times,
             int step, SimdLevel simd, Agreement& sum) {
  const Sgp4Batch batch(elements, nullptr, simd);
  const auto when = read_values<double>(stem + ".times");
  const auto states = read_values<double>(stem + ".states");
  const auto codes = read_values<std::uint8_t>(stem + ".codes");
  std::size_t row = 0;
  for (std::size_t i = 0; i < elements.size(); i += std::size_t(step)) {
    for (int k = 0; k < times; ++k, ++row) {
      const std::uint32_t object = std::uint32_t(i);
      double r[3], v[3];
      std::uint8_t code;
      batch.propagate_some({&object, 1}, when.at(2 * row), when.at(2 * row + 1), r, v, {&code, 1});
      const double* p = &states.at(6 * row);
      ++sum.states;
      if (code == std::uint8_t(Sgp4Code::absurd)) {
        // The reference has no such code: the radius must be implausible.
        const double a_km =
            std::cbrt(398600.8 / std::pow(elements[i].mean_motion_rad_per_min / 60.0, 2));
        const double far_km = 2.1 * a_km * (1.0 + elements[i].eccentricity);
        sum.mismatches += codes.at(row) != 0 || std::hypot(p[0], p[1], p[2]) < far_km;
        continue;
      }
      sum.mismatches += code != codes.at(row);
      if (code != 0 || codes.at(row) != 0) continue;
      const double km = std::hypot(r[0] * 1e-3 - p[0], r[1] * 1e-3 - p[1], r[2] * 1e-3 - p[2]);
      sum.worst_km = std::max(sum.worst_km, km);
    }
  }
}

class Report {
 public:
  explicit Report(bool json) : json_(json) {}

  /// `more_is_better`: whether the value must be above the target.
  void line(const char* name, double value, const char* unit, const char* anchor,
            std::optional<double> anchor_value, std::optional<double> target, bool more_is_better) {
    const bool met = !target || (more_is_better ? value >= *target : value <= *target);
    all_met_ = all_met_ && met;
    if (!json_) {
      std::printf("%-28s %12.4g %-8s", name, value, unit);
      if (target) std::printf(" target %-8.3g %s", *target, met ? "met" : "MISSED");
      if (anchor_value)
        std::printf("  %s %.3g, ratio %.1f", anchor, *anchor_value, value / *anchor_value);
      std::printf("\n");
      return;
    }
    JsonWriter w;
    w.begin_object().field("name", name).field("value", value).field("unit", unit);
    w.field("anchor", anchor);
    w.key("anchor_value");
    anchor_value ? w.value(*anchor_value) : w.null();
    w.key("ratio");
    anchor_value ? w.value(value / *anchor_value) : w.null();
    w.key("target");
    target ? w.value(*target) : w.null();
    w.key("met");
    target ? w.value(met) : w.null();
    w.end_object();
    std::printf("%s\n", w.text().c_str());
  }
  bool all_met() const { return all_met_; }

 private:
  bool json_;
  bool all_met_ = true;
};

/// A number after `"key": ` in the anchor's report.
std::optional<double> number_in(const std::string& text, const std::string& key) {
  const std::size_t at = text.find("\"" + key + "\": ");
  if (at == std::string::npos) return std::nullopt;
  return std::strtod(text.c_str() + at + key.size() + 4, nullptr);
}

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return text;
  char buffer[4096];
  while (std::size_t got = std::fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, got);
  return pclose(pipe) == 0 ? text : std::string();
}

struct TemporaryDirectory {
  std::string path;
  TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "dmise-sgp4-XXXXXX").string();
    if (!mkdtemp(name.data())) throw Error("no temporary directory");
    path = name;
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

/// `copies` of a catalogue one after the other, truncated to `objects`.
std::vector<MeanElements> repeated(const std::vector<MeanElements>& elements, std::size_t objects) {
  std::vector<MeanElements> all;
  all.reserve(objects);
  while (all.size() < objects) all.push_back(elements[all.size() % elements.size()]);
  return all;
}

double cone_ms(const std::vector<MeanElements>& elements, double jd1) {
  constexpr std::size_t objects = 61000, sensors = 100;
  const Sgp4Batch batch(repeated(elements, objects));
  Outputs out(objects);
  batch.propagate(jd1, 0.0, out.position, out.velocity, out.code);
  std::vector<Cone> cones;
  for (std::size_t k = 0; k < sensors;
       ++k) {  // sites all over the Earth, 10 degrees above the horizon
    const double z = 2.0 * (double(k) + 0.5) / double(sensors) - 1.0;
    const double longitude = 2.399963229728653 * double(k);
    const double x = std::sqrt(1.0 - z * z) * std::cos(longitude);
    const double y = std::sqrt(1.0 - z * z) * std::sin(longitude);
    cones.push_back({{6378137.0 * x, 6378137.0 * y, 6378137.0 * z}, {x, y, z}, 80.0 * deg});
  }
  std::vector<std::uint64_t> visible(cone_words(objects) * sensors);
  return 1e3 * median_seconds(15, [&](int) { cone_test(out.position, cones, visible); });
}

}  // namespace

int bench_sgp4(bool json) {
  // First, while this process is small, because child processes start as copies of it.
  const Sgp4Scale scales[] = {sgp4_at_scale(10'000, false), sgp4_at_scale(100'000, false),
                              sgp4_at_scale(1'000'000, false)};
  const Sgp4Scale with_elements = sgp4_at_scale(1'000'000, true);
  const TemporaryDirectory directory;
  const char* data = std::getenv("DMISE_DATA");
  const char* python = std::getenv("DMISE_PYTHON");
  const std::string catalogue_path = directory.path + "/catalogue.tle";
  if (data)
    write_file_whole(catalogue_path, read_text_file(std::string(data) +
                                                    "/tle/catalog_3le_2019-12-19_18470.txt.gz"));
  else
    write_file_whole(catalogue_path,
                     format_3le(synthetic_catalogue(
                         {.objects = 18470, .seed = 1, .newest_epoch = {2458837.5, 0.0}})));
  const std::string report = output_of(std::string(python ? python : "python3") + " '" +
                                       DMISE_SOURCE_DIR "/bench/sgp4_anchor.py' '" +
                                       directory.path + "' '" + catalogue_path + "'");
  std::vector<MeanElements> catalogue = test::elements_from_text(read_text_file(catalogue_path));
  std::vector<MeanElements> random;
  if (!report.empty())
    random = test::elements_from_text(read_text_file(directory.path + "/random.tle"));
  const bool real = !catalogue.empty();
  if (!real) catalogue = random;
  if (catalogue.empty())
    throw Error("no catalogue: set DMISE_DATA, or DMISE_PYTHON to one with sgp4");

  std::vector<MeanElements> near, deep;
  for (const MeanElements& e : catalogue)
    (2.0 * pi / e.mean_motion_rad_per_min < 225.0 ? near : deep).push_back(e);
  const double jd1 = 2458837.5;

  Report lines(json);
  const char* anchor = "Vallado C++ (PyPI sgp4, SatrecArray)";
  const auto near_anchor = number_in(report, "near_m_per_s");
  const auto deep_anchor = number_in(report, "deep_m_per_s");
  for (SimdLevel simd : {SimdLevel::avx512, SimdLevel::avx2, SimdLevel::sse2}) {
    if (simd > best_simd_level()) continue;
    const bool best = simd == best_simd_level();
    const std::string suffix = best ? "" : "_" + std::string(name(simd));
    const double near_target = simd == SimdLevel::avx512 ? 83.0
                               : simd == SimdLevel::avx2 ? 40.0
                                                         : 8.0;
    const double deep_target = simd == SimdLevel::avx512 ? 25.0
                               : simd == SimdLevel::avx2 ? 12.0
                                                         : 3.0;
    lines.line(("near_m_per_s" + suffix).c_str(), states_m_per_s(near, simd, jd1, 1), "M/s", anchor,
               near_anchor, near_target, true);
    lines.line(("near_8_times_m_per_s" + suffix).c_str(), states_m_per_s(near, simd, jd1, 8), "M/s",
               anchor, number_in(report, "near_8_times_m_per_s"), std::nullopt, true);
    if (!deep.empty())
      lines.line(("deep_m_per_s" + suffix).c_str(), states_m_per_s(deep, simd, jd1, 1), "M/s",
                 anchor, deep_anchor, deep_target, true);
  }
  if (!report.empty()) {
    const int times = int(*number_in(report, "times"));
    Agreement all;
    for (SimdLevel simd : {SimdLevel::sse2, SimdLevel::avx2, SimdLevel::avx512}) {
      if (simd > best_simd_level()) continue;
      compare(random, directory.path + "/random", times, 1, simd, all);
      if (real)
        compare(catalogue, directory.path + "/catalogue", times,
                int(*number_in(report, "catalogue_step")), simd, all);
    }
    const char* values = "Python sgp4";
    lines.line("max_error_km", all.worst_km, "km", values, std::nullopt, 1e-8, false);
    lines.line("code_mismatches", all.mismatches, "states", values, std::nullopt, 0.0, false);
  }
  lines.line("cone_61k_x_100_ms", cone_ms(catalogue, jd1), "ms", "0.14 ns a pair", std::nullopt,
             1.5, false);
  const char* process = "peak of a process of its own";
  const double small = scales[0].ns_per_object, great = scales[2].ns_per_object;
  lines.line("memory_1e6_mb", scales[2].peak_mb, "MB", process, std::nullopt, 400.0, false);
  lines.line("memory_1e6_with_elements_mb", with_elements.peak_mb, "MB", process, std::nullopt,
             std::nullopt, false);
  const char* one_call = "one time a call";
  for (std::size_t k = 0; k < 3; ++k)
    lines.line(("ns_per_object_1e" + std::to_string(4 + k)).c_str(), scales[k].ns_per_object, "ns",
               one_call, std::nullopt, std::nullopt, false);
  lines.line("cost_ratio_1e4_1e6", great / small, "1", one_call, std::nullopt, 2.0, false);
  return lines.all_met() ? 0 : 1;
}

}  // namespace dmise
