#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/frames/vec.h"
#include "core/sky/stars/star_map.h"
#include "core/sky/variables/gcvs_file.h"
#include "core/sky/variables/light_curve.h"
#include "core/time/julian_date.h"

namespace dmise {

/// When an observer sees stars, as the times of variable stars count.
struct VariableTime {
  double jd_utc = 0.0;
  Vec<Gcrs> observer_from_sun_m;

  /// Heliocentric Julian date (UTC): when light from a direction (unit) that comes to the observer
  /// passes the Sun, up to 8.3 minutes before or after.
  double heliocentric_jd(const Vec<Gcrs>& direction) const;
};

/// `tt`: of the observation.
VariableTime variable_time(const Tt& tt, const Vec<Gcrs>& observer_from_sun_m);

/// The variable stars among the stars of a catalogue.
class VariableStars {
 public:
  struct Star {
    std::uint32_t place = 0;  // index of the star in the catalogue
    std::string name, type;
    StarLightCurve curve;  // `constant`: it is drawn with the catalogue's magnitude
    // V between which its light is, as a catalogue has it; the mean is over a period.
    double brightest_v_mag = 0.0, mean_v_mag = 0.0, faintest_v_mag = 0.0;

    bool varies() const { return curve.shape != LightCurveShape::constant; }
  };

  /// Takes a record for the star of the catalogue that is nearest to it, within `same_star_rad` at
  /// J2000.0 and, where the record has magnitudes, no more than 1.5 mag outside its range (4.5
  /// brighter where they are not of V). No star is two variables, and no variable two stars: nearer
  /// pairs come first.
  VariableStars(const StarMap& map, const VariableReading& reading);

  /// By rising place.
  std::span<const Star> stars() const { return stars_; }
  /// The variable at a place of the catalogue; null if that star is none.
  const Star* find(std::uint32_t place) const;

  /// V of a star in a direction (unit), whose catalogue has `v_mag`.
  double v_mag(std::uint32_t place, double v_mag, const VariableTime& time,
               const Vec<Gcrs>& direction) const;
  /// The brightest that a star is drawn whose catalogue has `v_mag`.
  double brightest_v_mag(std::uint32_t place, double v_mag) const;

  std::size_t records() const { return records_; }  // stars of the file that have a place
  /// The first line that could not be used; empty if there was none.
  const std::string& problem() const { return problem_; }
  std::size_t problems() const { return problems_; }

 private:
  std::vector<Star> stars_;
  std::size_t records_ = 0, problems_ = 0;
  std::string problem_;
};

/// A catalogue with the variable stars of a file. Throws `ConfigError` as `parse_gcvs` does.
std::shared_ptr<const StarMap> with_variable_stars(const std::shared_ptr<const StarMap>& map,
                                                   const std::string& path);

/// Searches a catalogue as `query_cone` does, by the brightest that its stars are drawn.
void query_brightest(const StarMap& map, const Vec<Gcrs>& axis, double radius_rad,
                     double faintest_v_mag, std::vector<std::uint32_t>& found);

/// Searches a catalogue as `query_cone` does, by the brightest that its stars may be seen.
void query_possible(const StarMap& map, const Vec<Gcrs>& axis, double radius_rad,
                    double faintest_v_mag, std::vector<std::uint32_t>& found);

}  // namespace dmise
