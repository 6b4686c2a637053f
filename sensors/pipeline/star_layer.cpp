#include "sensors/pipeline/star_layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "core/config/effect_list.h"
#include "core/effects/frame_effects.h"
#include "core/optics/deposit.h"
#include "core/optics/projection.h"
#include "core/optics/snapshots.h"
#include "sensors/pipeline/row_window.h"
#include "sensors/pipeline/spectra.h"
#include "sensors/pipeline/star_path_grid.h"
#include "sensors/pipeline/star_snapshots.h"
#include "sensors/pipeline/stopwatch.h"
#include "sensors/pipeline/throughput.h"

namespace dmise {
namespace {

/// Stars move by less than this between the catalogue's place and the apparent one: refraction at
/// the horizon 0.6 deg, aberration 0.006, Barnard's star over two centuries 0.6.
constexpr double widest_shift_rad = 1.3 * deg;

/// Stars that are drawn at a time: what is known of them stays in the cache, and is too small for
/// memory of its own.
constexpr std::size_t stars_at_a_time = 512;

/// So many stars of a large catalogue are placed by a grid over the detector; fewer, and those of
/// small catalogues, one by one.
constexpr std::size_t least_for_grid = 8192;

/// Of the faintest source that matters, which has ten times a pixel's noise: the paths of stars
/// that a grid placed may be summed so roughly, in a pixel.
constexpr double missed_share = 1e-4;

StarColumns columns_of(const StarTable& stars) {
  return {.epoch_jyear = stars.epoch_jyear,
          .ra_rad = stars.ra_rad,
          .dec_rad = stars.dec_rad,
          .pm_ra_cosdec_rad_per_yr = stars.pm_ra_cosdec_rad_per_yr,
          .pm_dec_rad_per_yr = stars.pm_dec_rad_per_yr,
          .parallax_rad = stars.parallax_rad};
}

/// Sorts stars by the part of the field that they are in, row by row: those that are drawn one
/// after the other share pixels, which then stay in the cache.
void sort_by_place(std::vector<std::uint32_t>& stars, const Column<Vec<Gcrs>>& direction,
                   const Rotation<CameraFrame, Gcrs>& camera, double half_field_rad) {
  constexpr int tiles = 96;  // along each side
  const double scale = 0.5 * tiles / std::tan(0.5 * std::min(half_field_rad, 2.0));
  const auto tile = [&](std::uint32_t star) {
    const Vec<CameraFrame> at = camera * direction[star];
    const double stretch = scale / std::max(1e-3, 1.0 + at.z);  // stereographic
    const auto along = [&](double x) {
      return std::size_t(std::clamp(0.5 * tiles + x * stretch, 0.0, tiles - 1.0));
    };
    return along(at.y) * tiles + along(at.x);
  };
  std::vector<std::uint32_t> first(tiles * tiles + 1, 0), sorted(stars.size());
  std::vector<std::uint16_t> of(stars.size());
  for (std::size_t i = 0; i < stars.size(); ++i)
    ++first[(of[i] = std::uint16_t(tile(stars[i]))) + 1];
  for (std::size_t t = 1; t < first.size(); ++t) first[t] += first[t - 1];
  for (std::size_t i = 0; i < stars.size(); ++i) sorted[first[of[i]]++] = stars[i];
  stars = std::move(sorted);
}

}  // namespace

/// A star with its way over the detector.
struct StarLayer::Trail {
  std::uint64_t id = 0;
  std::uint32_t number = 0;  // by which it scintillates
  std::uint32_t place = 0;   // in the table of the catalogue
  double v_mag = 0.0, bv = 0.0;
  Vec<Gcrs> middle;                             // apparent direction in mid exposure
  std::array<PixelPosition, 3> pixel;           // start, middle, end
  std::optional<double> airmass, illumination;  // of its middle, if they are known already
  std::optional<Vec<Gcrs>> astrometric;         // where it is no catalogue's or a grid placed it
};

/// What an exposure's stars have in common.
struct StarLayer::Exposure {
  const View& view;
  const StarTable& stars;
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

  /// Trails of those that the projection can image throughout the exposure.
  std::vector<Trail> trails(std::span<const std::uint32_t> which) const;
  /// The same by the grid, without those that don't come near the frame. `direction`: of all stars.
  std::vector<Trail> trails_by_grid(std::span<const std::uint32_t> which,
                                    const Column<Vec<Gcrs>>& direction) const;
  /// The path of what stands at an astrometric place; none: it is not imaged or beside the frame.
  std::optional<StarPath> path(const Vec<Gcrs>& astrometric) const;
  std::optional<StarPath> exact_path(const Vec<Gcrs>& astrometric) const;
  void make_grid() {
    if (!grid)
      grid.emplace(view, [this](const Vec<Gcrs>& astrometric) { return exact_path(astrometric); });
  }
  /// The part of the sky without air and aberration, a cone, that light in the frame comes from.
  std::pair<Vec<Gcrs>, double> seen_cone() const;
  /// Factors of the air on their light.
  std::vector<double> factors_of_air(const std::vector<Trail>& trails, EffectTimes& times) const;
  /// Adds the arcs of a star's spectrum, with the light of `arc`.
  void spread(const Arc& arc, const Trail& trail, std::vector<Arc>& parts) const;
  bool hides(const Vec<Gcrs>& apparent) const { return earth && earth->hides_direction(apparent); }

 private:
  Trail trail_of(std::uint32_t star) const {
    return {.id = stars.id[star],
            .number = stars.id[star],
            .place = star,
            .v_mag = stars.v_mag[star],
            .bv = stars.bv[star]};
  }
};

std::vector<StarLayer::Trail> StarLayer::Exposure::trails(
    std::span<const std::uint32_t> which) const {
  const auto& optics = view.sensor().camera.optics;
  std::vector<Trail> trails(which.size());
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

std::optional<StarPath> StarLayer::Exposure::exact_path(const Vec<Gcrs>& astrometric) const {
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

std::optional<StarPath> StarLayer::Exposure::path(const Vec<Gcrs>& astrometric) const {
  if (grid) {
    StarPath path;
    const auto found = grid->find(astrometric, path);
    if (found == StarPathGrid::Found::path) return path;
    if (found == StarPathGrid::Found::beside) return std::nullopt;
  }
  return exact_path(astrometric);
}

std::vector<StarLayer::Trail> StarLayer::Exposure::trails_by_grid(
    std::span<const std::uint32_t> which, const Column<Vec<Gcrs>>& direction) const {
  std::vector<Trail> trails;
  trails.reserve(which.size());
  for (const std::uint32_t i : which) {
    const StarPlace place{.ra_rad = stars.ra_rad[i],
                          .dec_rad = stars.dec_rad[i],
                          .pm_ra_cosdec_rad_per_yr = stars.pm_ra_cosdec_rad_per_yr[i],
                          .pm_dec_rad_per_yr = stars.pm_dec_rad_per_yr[i],
                          .parallax_rad = stars.parallax_rad[i],
                          .epoch_jyear = stars.epoch_jyear};
    const Vec<Gcrs> astrometric = places[1].astrometric(CataloguedStar(place, direction[i]));
    const auto at = path(astrometric);
    if (!at) continue;
    Trail& trail = trails.emplace_back(trail_of(i));
    trail.astrometric = astrometric;
    trail.middle = at->middle, trail.pixel = at->pixel;
    trail.airmass = at->airmass, trail.illumination = at->illumination;
  }
  return trails;
}

std::pair<Vec<Gcrs>, double> StarLayer::Exposure::seen_cone() const {
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

std::vector<double> StarLayer::Exposure::factors_of_air(const std::vector<Trail>& trails,
                                                        EffectTimes& times) const {
  std::vector<SightLine> lines;
  lines.reserve(trails.size());
  for (const Trail& trail : trails)
    lines.push_back({trail.middle, trail.bv, SightLine::Source::star, trail.number,
                     view.turns_rad_per_s(trail.middle), trail.airmass});
  return throughput.of_air(lines, times);
}

void StarLayer::Exposure::spread(const Arc& arc, const Trail& trail,
                                 std::vector<Arc>& parts) const {
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

namespace {

/// Deposits arcs, each as far as it is not behind something, as spectra where `spread` makes them
/// of an arc's number.
template <class Spread>
std::vector<Deposited> add_past(const OcclusionMask& mask, std::span<const Arc> arcs,
                                const Spread& spread, OpticsStage& optics,
                                ExpectedElectronImage& image) {
  if (mask.empty() && !spread) return optics.add(arcs, image);
  std::vector<Arc> free;
  std::vector<std::size_t> star;
  std::vector<Arc> whole;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    whole.clear();
    if (spread)
      spread(i, whole);
    else
      whole.push_back(arcs[i]);
    for (const Arc& part : mask.empty() ? whole : mask.past(whole)) {
      free.push_back(part);
      star.push_back(i);
    }
  }
  std::vector<Deposited> deposited(arcs.size());
  const auto parts = optics.add(free, image);
  for (std::size_t k = 0; k < parts.size(); ++k) deposited[star[k]] = deposited[star[k]] + parts[k];
  return deposited;
}

/// Deposits snapshots of arcs at even times of each.
std::vector<Deposited> add_snapshots(const View& view, std::span<const Arc> arcs, int count,
                                     OpticsStage& optics, const OcclusionMask& mask,
                                     ExpectedElectronImage& image) {
  std::vector<Deposited> deposited;
  for (const Arc& arc : arcs) {
    std::vector<Arc> points = as_snapshots({&arc, 1}, count);
    for (Arc& point : points) point.signal_e *= view.illumination(point.middle);
    Deposited star;
    for (const Deposited& part : add_past(mask, points, optics, image)) star = star + part;
    deposited.push_back(star);
  }
  return deposited;
}

}  // namespace

/// Stars around the boresight of mid exposure, wide enough for the field to have turned.
std::vector<std::uint32_t> StarLayer::candidates(const View& view, double faintest_v_mag) const {
  const auto boresight = [&](SimTime t) {
    return view.camera_from_gcrs(t).inverse() * Vec<CameraFrame>{0, 0, 1};
  };
  const Vec<Gcrs> middle = boresight(view.times().middle);
  const FrameTimes times = view.times_of_all_rows();
  const double turned =
      std::max(angle_rad(middle, boresight(times.start)), angle_rad(middle, boresight(times.end)));
  std::vector<std::uint32_t> found;
  query_cone(*map_, middle,
             half_diagonal_rad(view.sensor().camera.optics) + turned + widest_shift_rad,
             faintest_v_mag, found);
  return found;
}

StarLayer::StarLayer(const SensorConfig& sensor, std::shared_ptr<const StarMap> map,
                     double faintest_v_mag)
    : map_(std::move(map)),
      light_(sensor.camera.band),
      faintest_filled_v_mag_(map_->summary.faintest_filled_v_mag) {
  if (!scene_facts(sensor).synthetic_stars) return;
  auto synthetic = std::make_unique<const SyntheticStars>(map_, faintest_v_mag,
                                                          *sensor.synthetic_stars_to_v_mag);
  if (synthetic->from_v_mag() < synthetic->to_v_mag()) synthetic_ = std::move(synthetic);
}

DrawnStars StarLayer::drawn(double limit_v_mag, const EffectSet& effects) const {
  const double complete = std::min(limit_v_mag, faintest_filled_v_mag_);
  if (!synthetic_) return complete;
  // Stars that are left out at the bright end are in the smooth starlight with all fainter ones.
  if (limit_v_mag < synthetic_->from_v_mag()) return {limit_v_mag, true};
  const double to =
      std::min(synthetic_->to_v_mag(),
               SyntheticBackground::limit_v_mag(effects.level(SyntheticBackground::facts)));
  return {std::max(synthetic_->from_v_mag(), to), true};
}

std::uint32_t StarLayer::count(const View& view, double faintest_v_mag, double margin_px) const {
  const Exposure exposure{.view = view, .stars = map_->stars};
  const auto& grid = view.sensor().camera.optics;
  std::uint32_t inside = 0;
  for (const Trail& trail : exposure.trails(candidates(view, faintest_v_mag))) {
    if (exposure.hides(trail.middle)) continue;
    const auto [start, middle, end] = trail.pixel;
    const auto [first_x, last_x] = std::minmax({start.x_px, middle.x_px, end.x_px});
    const auto [first_y, last_y] = std::minmax({start.y_px, middle.y_px, end.y_px});
    inside += last_x > -0.5 - margin_px && first_x < grid.columns - 0.5 + margin_px &&
              last_y > -0.5 - margin_px && first_y < grid.rows - 0.5 + margin_px;
  }
  return inside;
}

std::uint32_t StarLayer::draw(const View& view, OpticsStage& optics, const OcclusionMask& mask,
                              ExpectedElectronImage& image, double faintest_v_mag,
                              std::vector<StarTruth>* truth, EffectTimes& times) const {
  Exposure exposure{.view = view, .stars = map_->stars};
  std::vector<std::uint32_t> found = candidates(view, faintest_v_mag);
  const int snapshots = view.sensor().effects.snapshots();
  const bool by_grid = !map_->is_small() && found.size() >= least_for_grid && snapshots == 0;
  if (by_grid) {
    exposure.make_grid();
    sort_by_place(found, map_->index.direction, exposure.camera[1],
                  half_diagonal_rad(view.sensor().camera.optics));
  }
  // OpenGL's pictures are read back whole, so that there all go at once.
  const std::size_t at_a_time =
      snapshots ? std::max<std::size_t>(1, found.size()) : stars_at_a_time;
  std::uint32_t inside = 0;
  for (std::size_t begin = 0; begin < found.size(); begin += at_a_time) {
    const auto which = std::span(found).subspan(begin, std::min(at_a_time, found.size() - begin));
    inside += draw(
        exposure,
        by_grid ? exposure.trails_by_grid(which, map_->index.direction) : exposure.trails(which),
        by_grid ? missed_share * optics.limit_e() : 0.0, optics, mask, image, truth, times);
  }
  if (!synthetic_ || faintest_v_mag < synthetic_->from_v_mag()) return inside;
  double drawing_s = 0.0;
  const double before_s = times.sum_s();
  {
    Stopwatch timing(drawing_s);
    inside += draw_synthetic(exposure, optics, mask, image, truth, times);
  }
  times[SyntheticBackground::facts] += std::max(0.0, drawing_s - (times.sum_s() - before_s));
  return inside;
}

std::uint32_t StarLayer::draw_synthetic(Exposure& exposure, OpticsStage& optics,
                                        const OcclusionMask& mask, ExpectedElectronImage& image,
                                        std::vector<StarTruth>* truth, EffectTimes& times) const {
  const EffectSet& effects = exposure.view.sensor().effects;
  const double limit = SyntheticBackground::limit_v_mag(effects.level(SyntheticBackground::facts));
  const auto [axis, radius_rad] = exposure.seen_cone();
  if (synthetic_->expected_around(axis, radius_rad, limit) >= double(least_for_grid))
    exposure.make_grid();
  std::uint32_t inside = 0;
  synthetic_->visit(axis, radius_rad, limit, [&](const SyntheticStars::Stars& stars) {
    std::vector<Trail> trails;
    for (std::size_t i = 0; i < stars.id.size(); ++i)
      if (const auto at = exposure.path(stars.direction[i]))
        trails.push_back({.id = stars.id[i],
                          .number = std::uint32_t(stars.id[i] ^ stars.id[i] >> 31),
                          .v_mag = stars.v_mag[i],
                          .bv = stars.bv[i],
                          .middle = at->middle,
                          .pixel = at->pixel,
                          .airmass = at->airmass,
                          .illumination = at->illumination,
                          .astrometric = stars.direction[i]});
    inside += draw(exposure, std::move(trails), missed_share * optics.limit_e(), optics, mask,
                   image, truth, times);
  });
  return inside;
}

std::uint32_t StarLayer::draw(const Exposure& exposure, std::vector<Trail> trails,
                              double may_miss_e, OpticsStage& optics, const OcclusionMask& mask,
                              ExpectedElectronImage& image, std::vector<StarTruth>* truth,
                              EffectTimes& times) const {
  const View& view = exposure.view;
  {
    Stopwatch timing(times[EarthOccultation::facts]);
    std::erase_if(trails, [&](const Trail& t) { return exposure.hides(t.middle); });
  }
  const auto factor_of_air = exposure.factors_of_air(trails, times);
  const int snapshots = view.sensor().effects.snapshots();
  const bool in_snapshots = snapshots && (trails.empty() || !trails[0].airmass);
  std::vector<Arc> arcs;
  const double electrons_per_rate =
      exposure.throughput.electrons_per_photon_m2() * exposure.times.seconds();
  arcs.reserve(trails.size());
  for (std::size_t i = 0; i < trails.size(); ++i) {
    const auto& t = trails[i];
    arcs.push_back({t.pixel[0], t.pixel[1], t.pixel[2],
                    light_.photons_per_s_m2(t.v_mag, t.bv) * electrons_per_rate * factor_of_air[i] *
                        (in_snapshots     ? 1.0
                         : t.illumination ? *t.illumination
                                          : view.illumination(t.pixel[1])),
                    0.0, may_miss_e});
  }
  if (view.rolls())
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      arcs[i] = rolled(view, arcs[i]);
      trails[i].pixel = {arcs[i].start, arcs[i].middle, arcs[i].end};
    }
  std::vector<Deposited> deposited;
  if (in_snapshots && view.rolls()) {
    deposited = add_snapshots(view, arcs, snapshots, optics, mask, image);
  } else if (in_snapshots) {
    std::vector<std::uint32_t> drawn;
    std::vector<double> signal_e;
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      drawn.push_back(trails[i].place);
      signal_e.push_back(arcs[i].signal_e);
    }
    deposited = draw_star_snapshots(view, exposure.columns, drawn, signal_e, snapshots,
                                    exposure.spectra ? &*exposure.spectra : nullptr,
                                    exposure.stars.bv, optics, mask, image);
  } else {
    std::function<void(std::size_t, std::vector<Arc>&)> spread;
    if (exposure.spectra)
      spread = [&](std::size_t i, std::vector<Arc>& parts) {
        exposure.spread(arcs[i], trails[i], parts);
      };
    deposited = add_past(mask, arcs, spread, optics, image);
  }
  std::uint32_t inside = 0;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (deposited[i].signal_e <= 0.0) continue;
    ++inside;
    const Trail& t = trails[i];
    if (truth)
      truth->push_back({t.id, t.v_mag, t.bv, deposited[i].x_px, deposited[i].y_px,
                        deposited[i].signal_e, t.pixel[0], t.pixel[1], t.pixel[2]});
  }
  return inside;
}

}  // namespace dmise
