#include "sensors/pipeline/star_layer.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "core/effects/frame_effects.h"
#include "core/optics/deposit.h"
#include "core/optics/projection.h"
#include "core/optics/snapshots.h"
#include "sensors/pipeline/row_window.h"
#include "sensors/pipeline/spectra.h"
#include "sensors/pipeline/star_snapshots.h"
#include "sensors/pipeline/stopwatch.h"
#include "sensors/pipeline/throughput.h"

namespace dmise {
namespace {

/// Stars move by less than this between the catalogue's place and the apparent one: refraction at
/// the horizon 0.6 deg, aberration 0.006, Barnard's star over two centuries 0.6.
constexpr double widest_shift_rad = 1.3 * deg;

/// Stars that are drawn at a time: what is known of them stays in the cache.
constexpr std::size_t stars_at_a_time = 2048;

/// A star's way over the detector.
struct Trail {
  std::uint32_t star = 0;
  Vec<Gcrs> middle;                    // apparent direction in mid exposure
  std::array<PixelPosition, 3> pixel;  // start, middle, end
};

StarColumns columns_of(const StarTable& stars) {
  return {.epoch_jyear = stars.epoch_jyear,
          .ra_rad = stars.ra_rad,
          .dec_rad = stars.dec_rad,
          .pm_ra_cosdec_rad_per_yr = stars.pm_ra_cosdec_rad_per_yr,
          .pm_dec_rad_per_yr = stars.pm_dec_rad_per_yr,
          .parallax_rad = stars.parallax_rad};
}

}  // namespace

/// What an exposure's stars have in common.
struct StarLayer::Exposure {
  const View& view;
  const StarTable& stars;
  StarColumns columns = columns_of(stars);
  FrameTimes times = view.times_of_all_rows();
  std::array<SimTime, 3> instants = {times.start, times.middle, times.end};
  std::array<ApparentPlaces, 3> places = {view.places(instants[0]), view.places(instants[1]),
                                          view.places(instants[2])};
  std::optional<EarthOccultation> earth = view.earth_occultation(instants[1]);
  Throughput throughput{view};
  std::array<Vec<Gcrs>, 3> up = {view.up(instants[0]), view.up(instants[1]), view.up(instants[2])};
  std::optional<Spectra> spectra = Spectra::over(view);

  /// Trails of those that the projection can image throughout the exposure.
  std::vector<Trail> trails(std::span<const std::uint32_t> which) const;
  /// Factors of the air on their light.
  std::vector<double> factors_of_air(const std::vector<Trail>& trails, EffectTimes& times) const;
  /// Adds the arcs of a star's spectrum, with the light of `arc`.
  void spread(const Arc& arc, const Trail& trail, std::vector<Arc>& parts) const;
  bool hides(const Vec<Gcrs>& apparent) const { return earth && earth->hides_direction(apparent); }
};

std::vector<Trail> StarLayer::Exposure::trails(std::span<const std::uint32_t> which) const {
  const auto& optics = view.sensor().camera.optics;
  std::vector<Trail> trails(which.size());
  std::vector<bool> imaged(which.size(), true);
  std::vector<Vec<Gcrs>> direction(which.size());
  for (std::size_t k = 0; k < instants.size(); ++k) {
    places[k].stars(columns, which, direction);
    const auto camera = view.camera_from_gcrs(instants[k]);
    for (std::size_t i = 0; i < which.size(); ++i) {
      const auto pixel = project(optics, camera * direction[i]);
      imaged[i] = imaged[i] && pixel;
      if (pixel) trails[i].pixel[k] = *pixel;
      if (k == 1) trails[i].middle = direction[i];
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < which.size(); ++i) {
    if (!imaged[i]) continue;
    trails[kept] = trails[i];
    trails[kept++].star = which[i];
  }
  trails.resize(kept);
  return trails;
}

std::vector<double> StarLayer::Exposure::factors_of_air(const std::vector<Trail>& trails,
                                                        EffectTimes& times) const {
  std::vector<SightLine> lines;
  lines.reserve(trails.size());
  for (const Trail& trail : trails)
    lines.push_back({trail.middle, stars.bv[trail.star], SightLine::Source::star,
                     stars.id[trail.star], view.turns_rad_per_s(trail.middle)});
  return throughput.of_air(lines, times);
}

void StarLayer::Exposure::spread(const Arc& arc, const Trail& trail,
                                 std::vector<Arc>& parts) const {
  Arc blue, red;
  PixelPosition* const of_blue[] = {&blue.start, &blue.middle, &blue.end};
  PixelPosition* const of_red[] = {&red.start, &red.middle, &red.end};
  for (std::size_t k = 0; k < instants.size(); ++k) {
    Vec<Gcrs> apparent;
    places[k].stars(columns, {&trail.star, 1}, {&apparent, 1});
    const SpectrumEnds ends = spectra->ends(apparent, Refraction::star, up[k],
                                            view.camera_from_gcrs(instants[k]), trail.pixel[k]);
    *of_blue[k] = ends.blue;
    *of_red[k] = ends.red;
  }
  spectra->add(arc, blue, red, trail.middle, stars.bv[trail.star], parts);
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

StarLayer::StarLayer(const SensorConfig& sensor, std::shared_ptr<const StarMap> map)
    : map_(std::move(map)),
      light_(sensor.camera.band),
      faintest_filled_v_mag_(map_->summary.faintest_filled_v_mag) {}

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
  const Exposure exposure{.view = view, .stars = map_->stars};
  const std::vector<std::uint32_t> found = candidates(view, faintest_v_mag);
  // OpenGL's pictures are read back whole, so that there all go at once.
  const std::size_t at_a_time =
      view.sensor().effects.snapshots() ? std::max<std::size_t>(1, found.size()) : stars_at_a_time;
  std::uint32_t inside = 0;
  for (std::size_t begin = 0; begin < found.size(); begin += at_a_time) {
    const auto which = std::span(found).subspan(begin, std::min(at_a_time, found.size() - begin));
    inside += draw(exposure, which, optics, mask, image, truth, times);
  }
  return inside;
}

std::uint32_t StarLayer::draw(const Exposure& exposure, std::span<const std::uint32_t> which,
                              OpticsStage& optics, const OcclusionMask& mask,
                              ExpectedElectronImage& image, std::vector<StarTruth>* truth,
                              EffectTimes& times) const {
  const View& view = exposure.view;
  const StarTable& stars = exposure.stars;
  std::vector<Trail> trails = exposure.trails(which);
  {
    Stopwatch timing(times[EarthOccultation::facts]);
    std::erase_if(trails, [&](const Trail& t) { return exposure.hides(t.middle); });
  }
  const auto factor_of_air = exposure.factors_of_air(trails, times);
  const int snapshots = view.sensor().effects.snapshots();
  std::vector<Arc> arcs;
  const double electrons_per_rate =
      exposure.throughput.electrons_per_photon_m2() * exposure.times.seconds();
  arcs.reserve(trails.size());
  for (std::size_t i = 0; i < trails.size(); ++i) {
    const auto& t = trails[i];
    arcs.push_back({t.pixel[0], t.pixel[1], t.pixel[2],
                    light_.photons_per_s_m2(stars.v_mag[t.star], stars.bv[t.star]) *
                        electrons_per_rate * factor_of_air[i] *
                        (snapshots ? 1.0 : view.illumination(t.pixel[1]))});
  }
  if (view.rolls())
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      arcs[i] = rolled(view, arcs[i]);
      trails[i].pixel = {arcs[i].start, arcs[i].middle, arcs[i].end};
    }
  std::vector<Deposited> deposited;
  if (snapshots && view.rolls()) {
    deposited = add_snapshots(view, arcs, snapshots, optics, mask, image);
  } else if (snapshots) {
    std::vector<std::uint32_t> drawn;
    std::vector<double> signal_e;
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      drawn.push_back(trails[i].star);
      signal_e.push_back(arcs[i].signal_e);
    }
    deposited = draw_star_snapshots(view, exposure.columns, drawn, signal_e, snapshots,
                                    exposure.spectra ? &*exposure.spectra : nullptr, stars.bv,
                                    optics, mask, image);
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
    const std::uint32_t star = trails[i].star;
    if (truth)
      truth->push_back({stars.id[star], stars.v_mag[star], stars.bv[star], deposited[i].x_px,
                        deposited[i].y_px, deposited[i].signal_e, trails[i].pixel[0],
                        trails[i].pixel[1], trails[i].pixel[2]});
  }
  return inside;
}

}  // namespace dmise
