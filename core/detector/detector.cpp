#include "core/detector/detector.h"

#include <charconv>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/detector/detector_figures.h"

namespace dmise {
namespace {

std::string text_of(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace

std::optional<DetectorFault> fault_of(const Detector& d) {
  for (const DetectorFigure& figure : detector_figures()) {
    const double v = d.*figure.value;
    const bool above = figure.least_open ? v > figure.least : v >= figure.least;
    if (!above || !(v <= figure.most))
      return DetectorFault{figure.key,
                           std::string("must be ") + (figure.least_open ? "> " : ">= ") +
                               text_of(figure.least) + " and <= " + text_of(figure.most),
                           v};
  }
  const struct {
    bool holds;
    const char *key, *reason;
    double got;
  } rules[] = {
      {d.adc_bits >= 1 && d.adc_bits <= most_adc_bits, "adc_bits",
       "must be 1..16: counts are 16-bit numbers in frames and messages", double(d.adc_bits)},
      {d.reference_px >= 0 && d.reference_px <= most_reference_px, "reference_px",
       "must be 0..1000", double(d.reference_px)},
      {d.bias_dn < std::exp2(d.adc_bits), "bias_dn", "must be below 2^adc_bits", d.bias_dn},
      {d.persistence_fraction == 0.0 || d.persistence_s >= 1e-3, "persistence_s",
       "must be >= 0.001 with persistence", d.persistence_s},
      {d.dark_doubling_k == 0.0 || d.dark_doubling_k >= 1.0, "dark_doubling_k", "must be 0 or >= 1",
       d.dark_doubling_k},
      {d.dark_doubling_k > 0.0 || d.temperature_c == d.dark_reference_c, "dark_doubling_k",
       "must be > 0 when temperature_c is not dark_reference_c", d.dark_doubling_k},
      {std::fmax(d.dark_e_per_s, d.hot_pixel_e_per_s) * thermal_factor(d) <= 1e9, "temperature_c",
       "dark current there must be <= 1e9 e-/s", d.temperature_c}};
  for (const auto& rule : rules)
    if (!rule.holds) return DetectorFault{rule.key, rule.reason, rule.got};
  return std::nullopt;
}

void check(const Detector& detector) {
  if (const auto fault = fault_of(detector))
    throw ConfigError("detector." + fault->key + ": " + fault->reason + ", got " +
                      text_of(fault->got));
}

double dark_current_at(double temperature_k, double reference_e_per_s, double reference_k,
                       double doubling_k) {
  return reference_e_per_s * std::exp2((temperature_k - reference_k) / doubling_k);
}

double thermal_factor(const Detector& d) {
  return d.dark_doubling_k > 0.0
             ? dark_current_at(d.temperature_c, 1.0, d.dark_reference_c, d.dark_doubling_k)
             : 1.0;
}

double dark_rate_e_per_s(const Detector& d) { return d.dark_e_per_s * thermal_factor(d); }

bool has_figure(const Detector& d, Effect effect) {
  switch (effect) {
    case Effect::prnu:
      return d.prnu_rms > 0.0;
    case Effect::dark_current:
      return d.dark_e_per_s > 0.0;
    case Effect::hot_pixels:
      return d.hot_pixel_fraction > 0.0 && d.hot_pixel_e_per_s > 0.0;
    case Effect::cosmic_rays:
      return d.cosmic_rays_per_px_s > 0.0 && d.cosmic_ray_e_per_px > 0.0;
    case Effect::reference_pixels:
      return d.reference_px > 0;
    case Effect::persistence:
      return d.persistence_fraction > 0.0;
    case Effect::blooming:
      return d.blooming;
    case Effect::interpixel_coupling:
      return d.interpixel_coupling > 0.0;
    case Effect::nonlinearity:
      return d.nonlinearity > 0.0;
    case Effect::column_noise:
      return d.column_noise_e > 0.0;
    case Effect::read_noise:
      return d.read_noise_e > 0.0;
    default:
      return true;
  }
}

Detector in_effect(const Detector& detector, const EffectSet& effects) {
  Detector d = detector;
  const auto off = [&](Effect effect) { return !effects.has(effect); };
  const double thermal = thermal_factor(d);
  d.dark_e_per_s = off(Effect::dark_current) ? 0.0 : d.dark_e_per_s * thermal;
  d.hot_pixel_e_per_s *= thermal;
  d.dark_reference_c = d.temperature_c;
  if (off(Effect::prnu)) d.prnu_rms = 0.0;
  if (off(Effect::hot_pixels)) d.hot_pixel_fraction = 0.0;
  if (off(Effect::cosmic_rays)) d.cosmic_rays_per_px_s = 0.0;
  if (off(Effect::reference_pixels)) d.reference_px = 0;
  if (off(Effect::persistence)) d.persistence_fraction = 0.0;
  // Without a full well nothing runs over.
  if (off(Effect::blooming) || off(Effect::full_well)) d.blooming = false;
  if (off(Effect::interpixel_coupling)) d.interpixel_coupling = 0.0;
  if (off(Effect::nonlinearity)) d.nonlinearity = 0.0;
  if (off(Effect::column_noise)) d.column_noise_e = 0.0;
  if (off(Effect::read_noise)) d.read_noise_e = 0.0;
  if (off(Effect::quantisation)) {
    d.gain_e_per_dn = 1.0;
    d.bias_dn = 0.0;
    d.adc_bits = most_adc_bits;
  }
  return d;
}

}  // namespace dmise
