#pragma once
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/optics/blur/deposit.h"
#include "core/sky/stars/star_map.h"
#include "core/sky/variables/variable_stars.h"
#include "sensors/scene/spectra.h"
#include "sensors/scene/throughput.h"
#include "sensors/scene/view.h"
#include "sensors/sky/star_path_grid.h"

namespace dmise {

/// Stars move by less than this between the catalogue's place and the apparent one: refraction at
/// the horizon 0.6 deg, aberration 0.006, Barnard's star over two centuries 0.6.
inline constexpr double widest_shift_rad = 1.3 * deg;

/// A star with its way over the detector.
struct StarTrail {
  std::uint64_t id = 0;
  std::uint32_t number = 0;  // by which it scintillates
  std::uint32_t place = 0;   // in the table of the catalogue
  double v_mag = 0.0, bv = 0.0;
  StarKind kind = StarKind::most;
  Vec<Gcrs> middle;                             // apparent direction in mid exposure
  std::array<PixelPosition, 3> pixel;           // start, middle, end
  std::optional<double> airmass, illumination;  // in its middle pixel, if they are known already
  std::optional<Vec<Gcrs>> astrometric;         // where it is no catalogue's or a grid placed it
};

StarColumns columns_of(const StarTable& stars);

/// What an exposure's stars have in common.
struct StarExposure {
  const View& view;
  const StarMap& map;
  const StarTable& stars = map.stars;
  StarColumns columns = columns_of(stars);
  FrameTimes times = view.times_of_all_rows();
  std::array<SimTime, 3> instants = {times.start, times.middle, times.end};
  std::array<ApparentPlaces, 3> places = {view.places(instants[0]), view.places(instants[1]),
                                          view.places(instants[2])};
  std::array<Rotation<CameraFrame, Gcrs>, 3> camera = {view.camera_from_gcrs(instants[0]),
                                                       view.camera_from_gcrs(instants[1]),
                                                       view.camera_from_gcrs(instants[2])};
  std::optional<EarthOccultation> earth = view.earth_occultation(instants[1]);
  Throughput throughput{view};
  std::array<Vec<Gcrs>, 3> up = {view.up(instants[0]), view.up(instants[1]), view.up(instants[2])};
  std::optional<Spectra> spectra = Spectra::over(view);
  std::optional<StarPathGrid> grid{};
  VariableTime variable_time = time_of(view);  // the time at mid exposure

  /// Trails of those that the projection can image throughout the exposure.
  std::vector<StarTrail> trails(std::span<const std::uint32_t> which) const;
  /// Trails by the grid, without those that don't come near the frame. `direction`: of all stars.
  std::vector<StarTrail> trails_by_grid(std::span<const std::uint32_t> which,
                                        const Column<Vec<Gcrs>>& direction) const;
  /// Paths of what stands at astrometric places, by the grid where there is one, and whether each
  /// is: it is imaged, and not beside the frame.
  struct Paths {
    std::vector<StarPath> path;
    std::vector<char> is_there;
  };
  Paths paths(std::span<const Vec<Gcrs>> astrometric) const;
  std::optional<StarPath> exact_path(const Vec<Gcrs>& astrometric) const;
  void make_grid() {
    if (!grid)
      grid.emplace(view, [this](const Vec<Gcrs>& astrometric) { return exact_path(astrometric); });
  }
  /// The part of the sky without air and aberration, a cone, that light in the frame comes from.
  std::pair<Vec<Gcrs>, double> seen_cone() const;
  /// Factors of the air on their light.
  std::vector<double> factors_of_air(const std::vector<StarTrail>& trails,
                                     EffectTimes& times) const;
  /// Multiplies the light of stars of known airmass by the same factors, to 1e-14 of them.
  void apply_air(const std::vector<StarTrail>& trails, std::span<const double> bv,
                 std::span<double> light, EffectTimes& times) const;
  /// Adds the arcs of a star's spectrum, with the light of `arc`.
  void spread(const Arc& arc, const StarTrail& trail, std::vector<Arc>& parts) const;
  bool hides(const Vec<Gcrs>& apparent) const { return earth && earth->hides_direction(apparent); }

 private:
  static VariableTime time_of(const View& view);
  double v_mag_of(std::uint32_t star) const {
    const double v_mag = stars.v_mag[star];
    return map.variables
               ? map.variables->v_mag(star, v_mag, variable_time, map.index.direction[star])
               : v_mag;
  }
  StarTrail trail_of(std::uint32_t star) const {
    return {.id = stars.id[star],
            .number = stars.id[star],
            .place = star,
            .v_mag = v_mag_of(star),
            .bv = stars.bv[star],
            .kind = stars.colour(star).kind};
  }
};

}  // namespace dmise
