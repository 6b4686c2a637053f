#include "core/products/unknown_fields.h"

#include <algorithm>
#include <initializer_list>

namespace dmise {
namespace {

using enum FrameFact;

/// Whether any of several facts is unknown.
bool lacks(const UnknownFacts& unknown, std::initializer_list<FrameFact> facts) {
  return std::any_of(facts.begin(), facts.end(), [&](FrameFact f) { return unknown.has(f); });
}

bool of_direction(std::string_view key, const UnknownFacts& unknown) {
  constexpr std::string_view keys[] = {"ra_deg",
                                       "dec_deg",
                                       "end1_ra_deg",
                                       "end1_dec_deg",
                                       "end2_ra_deg",
                                       "end2_dec_deg",
                                       "covariance_arcsec2",
                                       "end1_covariance_arcsec2",
                                       "end2_covariance_arcsec2",
                                       "position_angle_deg",
                                       "boresight_ra_deg",
                                       "boresight_dec_deg",
                                       "wcs"};
  return lacks(unknown, {pointing}) && std::ranges::find(keys, key) != std::end(keys);
}

/// Directions that are corrected for the observer, who must be known.
bool of_observer(std::string_view key, const UnknownFacts& unknown) {
  constexpr std::string_view positions[] = {"sensor_position_gcrs_m",
                                            "sensor_velocity_gcrs_m_per_s"};
  constexpr std::string_view corrections[] = {"corrected_ra_deg",
                                              "corrected_dec_deg",
                                              "aberration_removed",
                                              "refraction_removed",
                                              "refraction_offset_gcrs_m",
                                              "refraction_parallax_arcsec",
                                              "refraction_parallax_sigma_arcsec"};
  if (std::ranges::find(positions, key) != std::end(positions)) return lacks(unknown, {site, time});
  return lacks(unknown, {site, time, pointing}) &&
         std::ranges::find(corrections, key) != std::end(corrections);
}

/// Times. That of the start is 0, also without an exposure time.
bool of_time(std::string_view key, const UnknownFacts& unknown) {
  const bool is_start = key.starts_with("start_");
  if (key.ends_with("_utc"))
    return lacks(unknown, {time}) || (lacks(unknown, {exposure}) && !is_start);
  constexpr std::string_view of_light_curve[] = {"time_s", "period_s", "period_sigma_s",
                                                 "min_period_s"};
  const bool of_exposure =
      key.ends_with("_ns") || std::ranges::find(of_light_curve, key) != std::end(of_light_curve);
  return lacks(unknown, {exposure}) && of_exposure && !is_start;
}

bool of_light(std::string_view key, const UnknownFacts& unknown) {
  if (key == "magnitude" || key == "limiting_magnitude")
    return lacks(unknown, {zero_point, exposure});  // which may hold the air, without an extinction
  if (key == "magnitude_sigma" || key == "zero_point_mag") return lacks(unknown, {zero_point});
  if (key == "background_e") return lacks(unknown, {bias});
  if (key == "band") return lacks(unknown, {band});
  return key == "rate_arcsec_per_s" && lacks(unknown, {pointing, exposure});
}

}  // namespace

bool is_unknown(std::string_view key, const UnknownFacts& unknown) {
  return unknown.any() && (of_direction(key, unknown) || of_observer(key, unknown) ||
                           of_time(key, unknown) || of_light(key, unknown));
}

}  // namespace dmise
