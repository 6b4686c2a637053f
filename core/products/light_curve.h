#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "core/products/product_fields.h"

namespace dmise {

/// A period in the light of a streak, found by harmonics of it in the light along the line.
/// Errors are one sigma if the light repeats.
struct LightPeriod {
  double period_px = 0.0, period_sigma_px = 0.0;  // along the line
  // By the time that the object takes from end to end. The ends are known less well than the light
  // between them where the object is dark at one: then the exposure goes on beyond it.
  double period_s = 0.0, period_sigma_s = 0.0;
  // Half the difference between the most and the least light in a period, over the mean light.
  double amplitude = 0.0, amplitude_sigma = 0.0;
  std::uint32_t harmonics = 0;
  // Upper bound of the probability that noise on even light has a period as significant.
  double false_alarm = 0.0;

  bool operator==(const LightPeriod&) const = default;
};

/// Light of a streak over time, in bins of equal length along its line, from end 1 to end 2. Bins
/// without pixels that can be used are left out.
struct LightCurve {
  double bin_px = 0.0;           // length of a bin
  std::vector<double> along_px;  // middle of each bin from end 1
  // Time after the start of the exposure, with the delay of the row of a rolling shutter, of a
  // motion from end 1 to end 2 (`direction_known`).
  std::vector<double> time_s;
  std::vector<double> light_e, sigma_e;  // electrons of a bin and their error
  // Between the errors of a bin and of the next one: the PSF blurs the light of one over both.
  std::vector<double> correlation;
  std::optional<LightPeriod> period;  // where one is significant
  // Where the light varies without showing its period: shorter ones are a hundred times less
  // likely than the best.
  std::optional<double> min_period_px, min_period_s;

  bool operator==(const LightCurve&) const = default;
};

template <class V, MaybeConst<LightPeriod> P>
void visit_fields(V& v, P& p) {
  v("period_px", p.period_px);
  v("period_sigma_px", p.period_sigma_px);
  v("period_s", p.period_s);
  v("period_sigma_s", p.period_sigma_s);
  v("amplitude", p.amplitude);
  v("amplitude_sigma", p.amplitude_sigma);
  v("harmonics", p.harmonics);
  v("false_alarm", p.false_alarm);
}

template <class V, MaybeConst<LightCurve> L>
void visit_fields(V& v, L& light) {
  v("bin_px", light.bin_px);
  v("along_px", light.along_px);
  v.null_unless(true, "time_s", light.time_s);
  v("light_e", light.light_e);
  v("sigma_e", light.sigma_e);
  v("correlation", light.correlation);
  v("period", light.period);
  v("min_period_px", light.min_period_px);
  v("min_period_s", light.min_period_s);
}

}  // namespace dmise
