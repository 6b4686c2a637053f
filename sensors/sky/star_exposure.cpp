#include "sensors/sky/star_exposure.h"

#include <algorithm>

#include "core/optics/projection.h"

namespace dmise {

StarColumns columns_of(const StarTable& stars) {
  return {.epoch_jyear = stars.epoch_jyear,
          .ra_rad = stars.ra_rad,
          .dec_rad = stars.dec_rad,
          .pm_ra_cosdec_rad_per_yr = stars.pm_ra_cosdec_rad_per_yr,
          .pm_dec_rad_per_yr = stars.pm_dec_rad_per_yr,
          .parallax_rad = stars.parallax_rad};
}

VariableTime StarExposure::time_of(const View& view) {
  const EnvironmentState& environment = view.environment();
  return dmise::variable_time({environment.tt_jd1, environment.tt_jd2},
                              view.observer(view.times().middle).position_m - environment.sun_m);
}

std::vector<StarTrail> StarExposure::trails(std::span<const std::uint32_t> which) const {
  const auto& optics = view.sensor().camera.optics;
  std::vector<StarTrail> trails(which.size());
  std::vector<bool> imaged(which.size(), true);
  std::vector<Vec<Gcrs>> direction(which.size());
  for (std::size_t i = 0; i < which.size(); ++i) trails[i] = trail_of(which[i]);
  for (std::size_t k = 0; k < instants.size(); ++k) {
    places[k].stars(columns, which, direction);
    for (std::size_t i = 0; i < which.size(); ++i) {
      const auto pixel = project(optics, camera[k] * direction[i]);
      imaged[i] = imaged[i] && pixel;
      if (pixel) trails[i].pixel[k] = *pixel;
      if (k == 1) trails[i].middle = direction[i];
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < which.size(); ++i)
    if (imaged[i]) trails[kept++] = trails[i];
  trails.resize(kept);
  return trails;
}

std::optional<StarPath> StarExposure::exact_path(const Vec<Gcrs>& astrometric) const {
  const Optics& optics = view.sensor().camera.optics;
  StarPath path;
  for (std::size_t k = 0; k < instants.size(); ++k) {
    const Vec<Gcrs> direction = places[k].seen(astrometric);
    const auto pixel = project(optics, camera[k] * direction);
    if (!pixel) return std::nullopt;
    path.pixel[k] = *pixel;
    if (k == 1) path.middle = direction;
  }
  if (view.on_ground()) path.airmass = airmass(elevation_over(up[1], path.middle));
  path.illumination = view.illumination(path.pixel[1]);
  return path;
}

StarExposure::Paths StarExposure::paths(std::span<const Vec<Gcrs>> astrometric) const {
  Paths paths{std::vector<StarPath>(astrometric.size()),
              std::vector<char>(astrometric.size(), false)};
  std::vector<StarPathGrid::Found> found(astrometric.size(), StarPathGrid::Found::none);
  if (grid) grid->find(astrometric, paths.path, found);
  for (std::size_t i = 0; i < found.size(); ++i) {
    paths.is_there[i] = found[i] == StarPathGrid::Found::path;
    if (found[i] != StarPathGrid::Found::none) continue;
    const auto exact = exact_path(astrometric[i]);
    paths.is_there[i] = exact.has_value();
    if (exact) paths.path[i] = *exact;
  }
  return paths;
}

namespace {

/// Fetches what tells a star's light. Inline, as a function that only fetches is taken for one that
/// does nothing.
[[gnu::always_inline]] inline void prefetch(const StarTable& stars, std::uint32_t star) {
  __builtin_prefetch(stars.id.data() + star);
  __builtin_prefetch(stars.v_mag.data() + star);
  __builtin_prefetch(stars.bv.data() + star);
  __builtin_prefetch(stars.flags.data() + star);
}

}  // namespace

std::vector<StarTrail> StarExposure::trails_by_grid(std::span<const std::uint32_t> which,
                                                    const Column<Vec<Gcrs>>& direction) const {
  std::vector<Vec<Gcrs>> astrometric(which.size());
  for (const std::uint32_t star : which) prefetch(stars, star);
  places[1].astrometric(columns, which, {direction.data(), direction.size()}, astrometric);
  const Paths paths = this->paths(astrometric);
  std::vector<StarTrail> trails;
  trails.reserve(which.size());
  for (std::size_t i = 0; i < which.size(); ++i) {
    if (!paths.is_there[i]) continue;
    const StarPath& at = paths.path[i];
    StarTrail& trail = trails.emplace_back(trail_of(which[i]));
    trail.astrometric = astrometric[i];
    trail.middle = at.middle, trail.pixel = at.pixel;
    trail.airmass = at.airmass, trail.illumination = at.illumination;
  }
  return trails;
}

std::pair<Vec<Gcrs>, double> StarExposure::seen_cone() const {
  const Optics& optics = view.sensor().camera.optics;
  const Vec<Gcrs> axis = places[1].star_seen_at(camera[1].inverse() * Vec<CameraFrame>{0, 0, 1});
  const double widest_rad = half_diagonal_rad(optics);
  // Beyond the rim light of a source that is outside reaches the frame.
  constexpr double beside_px = 8.0, between = 1.02;
  constexpr int looks = 8;
  double radius_rad = 0.0;
  for (int i = 0; i <= looks; ++i)
    for (const auto& [x, y] :
         {std::array{double(i) / looks, 0.0}, std::array{double(i) / looks, 1.0},
          std::array{0.0, double(i) / looks}, std::array{1.0, double(i) / looks}}) {
      const auto rim = unproject(optics, {-beside_px + x * (optics.columns + 2 * beside_px),
                                          -beside_px + y * (optics.rows + 2 * beside_px)});
      if (!rim) return {axis, std::min(pi, widest_rad + widest_shift_rad)};
      for (std::size_t k = 0; k < instants.size(); ++k)
        radius_rad = std::max(radius_rad,
                              angle_rad(axis, places[k].star_seen_at(camera[k].inverse() * *rim)));
    }
  return {axis, std::min(pi, between * radius_rad)};
}

std::vector<double> StarExposure::factors_of_air(const std::vector<StarTrail>& trails,
                                                 EffectTimes& times) const {
  std::vector<SightLine> lines;
  lines.reserve(trails.size());
  for (const StarTrail& trail : trails)
    lines.push_back({trail.middle, trail.bv, SightLine::Source::star, trail.number,
                     view.turns_rad_per_s(trail.middle), trail.airmass});
  return throughput.of_air(lines, times);
}

void StarExposure::apply_air(const std::vector<StarTrail>& trails, std::span<const double> bv,
                             std::span<double> light, EffectTimes& times) const {
  if (!throughput.has_air()) return;
  const std::size_t n = trails.size();
  std::vector<Vec<Gcrs>> apparent(n);
  std::vector<double> airmass(n), rate_rad_per_s(n);
  std::vector<std::uint32_t> number(n);
  for (std::size_t i = 0; i < n; ++i) {
    apparent[i] = trails[i].middle;
    airmass[i] = *trails[i].airmass;
    rate_rad_per_s[i] = view.turns_rad_per_s(trails[i].middle);
    number[i] = trails[i].number;
  }
  throughput.apply_air({apparent, airmass, bv, rate_rad_per_s, number}, light, times);
}

void StarExposure::spread(const Arc& arc, const StarTrail& trail, std::vector<Arc>& parts) const {
  Arc blue, red;
  PixelPosition* const of_blue[] = {&blue.start, &blue.middle, &blue.end};
  PixelPosition* const of_red[] = {&red.start, &red.middle, &red.end};
  for (std::size_t k = 0; k < instants.size(); ++k) {
    Vec<Gcrs> apparent;
    if (trail.astrometric)
      apparent = places[k].seen(*trail.astrometric);
    else
      places[k].stars(columns, {&trail.place, 1}, {&apparent, 1});
    const SpectrumEnds ends =
        spectra->ends(apparent, Refraction::star, up[k], camera[k], trail.pixel[k]);
    *of_blue[k] = ends.blue;
    *of_red[k] = ends.red;
  }
  spectra->add(arc, blue, red, trail.middle, trail.bv, parts);
}

}  // namespace dmise
