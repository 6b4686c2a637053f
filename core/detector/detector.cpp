#include "core/detector/detector.h"

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/formatted.h"

namespace dmise {
namespace {

constexpr std::string_view in_headers[] = {"quantum_efficiency",
                                           "dark_e_per_s",
                                           "dark_reference_c",
                                           "temperature_c",
                                           "dark_doubling_k",
                                           "read_noise_e",
                                           "full_well_e",
                                           "gain_e_per_dn",
                                           "bias_dn",
                                           "prnu_rms",
                                           "hot_pixel_fraction",
                                           "hot_pixel_e_per_s",
                                           "column_noise_e",
                                           "nonlinearity",
                                           "interpixel_coupling",
                                           "persistence_fraction",
                                           "persistence_s",
                                           "cosmic_rays_per_px_s",
                                           "cosmic_ray_e_per_px",
                                           "cosmic_ray_depth_px",
                                           "adc_bits",
                                           "reference_px",
                                           "blooming"};

std::ptrdiff_t place_in_headers(const DetectorParameter& parameter) {
  return std::ranges::find(in_headers, parameter.key) - in_headers;
}

constexpr DetectorParameter quantum_efficiency{"quantum_efficiency",
                                               "QUANTEFF",
                                               "photo-electrons a photon, mean over the band",
                                               &Detector::quantum_efficiency,
                                               0.0,
                                               1.0,
                                               true};

std::vector<DetectorParameter> all_parameters() {
  std::vector<DetectorParameter> all{quantum_efficiency};
  DetectorEffects::for_each([&]<class Effect>() {
    for (const auto& own : Effect::parameters()) all.push_back(own.template in<Detector>());
  });
  std::ranges::stable_sort(all, {}, place_in_headers);
  return all;
}

/// Returns why a number is invalid for a parameter; empty if it is valid.
std::string complaint(const DetectorParameter& p, double number) {
  const bool above = p.least_open ? number > p.least : number >= p.least;
  if (above && number <= p.most) return "";
  if (std::holds_alternative<int Detector::*>(p.value))
    return "must be " + shortest_text(p.least) + ".." + shortest_text(p.most) +
           (p.reason.empty() ? "" : ": " + std::string(p.reason));
  return (p.least_open ? "must be > " : "must be >= ") + shortest_text(p.least) +
         " and <= " + shortest_text(p.most);
}

}  // namespace

std::span<const DetectorParameter> detector_parameters() {
  static const std::vector<DetectorParameter> all = all_parameters();
  return all;
}

bool in_every_header(const DetectorParameter& parameter) {
  return place_in_headers(parameter) < std::ssize(in_headers);
}

std::optional<DetectorFault> fault_of(const Detector& detector) {
  for (const DetectorParameter& p : detector_parameters())
    if (const std::string reason = complaint(p, p.number_of(detector)); !reason.empty())
      return DetectorFault{std::string(p.key), reason, p.number_of(detector)};
  std::optional<DetectorFault> fault;
  DetectorEffects::for_each([&]<class Effect>() {
    if constexpr (requires { Effect::fault(detector); })
      if (!fault) fault = Effect::fault(detector);
  });
  return fault;
}

void check(const Detector& detector) {
  if (const auto fault = fault_of(detector))
    throw ConfigError("detector." + fault->key + ": " + fault->reason + ", got " +
                      shortest_text(fault->got));
}

Detector acting_detector(const Detector& detector, const EffectSet& effects) {
  Detector d = detector;
  const double thermal = d.thermal_factor();
  d.dark_e_per_s *= thermal;
  d.hot_pixel_e_per_s *= thermal;
  d.dark_reference_c = d.temperature_c;
  DetectorEffects::for_each([&]<class Effect>() {
    if (!effects.has(Effect::facts)) static_cast<Effect&>(d).switch_off();
  });
  d.read_noise_e = d.fitted_noise_e(d.read_noise_e);
  return d;
}

bool reads_after_others(const Detector& d) {
  return d.interpixel_coupling > 0.0 || d.nonlinearity > 0.0 || d.persistence_fraction > 0.0 ||
         d.blooming || d.reference_px > 0 || d.is_spread() || d.EmGain::applies(d) ||
         d.ChargeTransfer::applies(d) || d.BrighterFatter::applies(d) || d.Ramp::applies(d);
}

Detector drawn_together(const Detector& acting, const EffectSet& effects) {
  Detector d = acting;
  if (effects.level(PhotonNoise::facts) != PhotonNoise::gaussian) return d;
  d.is_gaussian = true;
  std::swap(d.drawn_dark_e_per_s, d.dark_e_per_s);
  if (!reads_after_others(d)) std::swap(d.drawn_read_noise_e, d.read_noise_e);
  return d;
}

}  // namespace dmise
