#include "core/orbit/catalogue_interpolation.h"

#include <algorithm>
#include <cmath>

#include "core/time/clock.h"

namespace dmise {

namespace {

/// Positions and slopes at one tick: 3 x objects each.
struct Knot {
  std::vector<double> position_m, slope_m_per_s;
};

class Measurement {
 public:
  Measurement(const Sgp4Batch& batch, const Utc& start)
      : batch_(batch), clock_(start), velocity_(3 * batch.size()), code_(batch.size()) {
    error_.max_m.assign(batch.size(), 0.0);
    error_.code.assign(batch.size(), 0);
  }

  CatalogueInterpolationError run(const CatalogueInterpolationOptions& options) {
    const int before = ticks_before(options.order), behind = ticks_behind(options.order);
    std::vector<Knot> knots;
    for (int k = -before; k < options.intervals + behind; ++k)
      knots.push_back(knot(k * options.tick_s));
    std::vector<double> truth(3 * batch_.size());
    for (int k = 0; k < options.intervals; ++k) {
      for (int s = 1; s <= options.samples; ++s) {
        const double u = static_cast<double>(s) / (options.samples + 1);
        positions((k + u) * options.tick_s, truth);
        const HermiteWeights w = hermite_weights(options.order, u, options.tick_s);
        compare(w, &knots[static_cast<std::size_t>(k + before + w.first)], truth);
      }
    }
    for (std::size_t i = 0; i < batch_.size(); ++i)
      if (error_.code[i]) error_.max_m[i] = 0.0;
    return std::move(error_);
  }

 private:
  void positions(double t_s, std::vector<double>& out_m) {
    const Utc utc = clock_.utc(sim_seconds(t_s));
    batch_.propagate(utc.jd1, utc.jd2, out_m, velocity_, code_);
    for (std::size_t i = 0; i < code_.size(); ++i)
      if (error_.code[i] == 0) error_.code[i] = code_[i];
  }

  Knot knot(double t_s) {
    const std::size_t size = 3 * batch_.size();
    Knot k{std::vector<double>(size), std::vector<double>(size)};
    std::vector<double> before(size);
    positions(t_s - slope_half_step_s, before);
    positions(t_s + slope_half_step_s, k.slope_m_per_s);
    for (std::size_t j = 0; j < size; ++j)
      k.slope_m_per_s[j] = (k.slope_m_per_s[j] - before[j]) / (2 * slope_half_step_s);
    positions(t_s, k.position_m);
    return k;
  }

  void compare(const HermiteWeights& w, const Knot* first, const std::vector<double>& truth_m) {
    const std::size_t n = batch_.size();
    for (std::size_t i = 0; i < n; ++i) {
      double square = 0.0;
      for (const std::size_t j : {i, n + i, 2 * n + i}) {
        double difference = -truth_m[j];
        for (std::size_t k = 0; k < static_cast<std::size_t>(w.count); ++k)
          difference +=
              first[k].position_m[j] * w.position[k] + first[k].slope_m_per_s[j] * w.slope_s[k];
        square += difference * difference;
      }
      error_.max_m[i] = std::max(error_.max_m[i], std::sqrt(square));
    }
  }

  const Sgp4Batch& batch_;
  Clock clock_;
  std::vector<double> velocity_;
  std::vector<std::uint8_t> code_;
  CatalogueInterpolationError error_;
};

}  // namespace

CatalogueInterpolationError measure_catalogue_interpolation(
    const Sgp4Batch& batch, const Utc& start, const CatalogueInterpolationOptions& options) {
  return Measurement(batch, start).run(options);
}

}  // namespace dmise
