#include "sensors/light/star_layer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "core/base/stopwatch.h"
#include "core/base/units.h"
#include "core/config/sensors/effect_list.h"
#include "core/effects/frame_effects.h"
#include "core/optics/blur/deposit.h"
#include "core/optics/blur/snapshots.h"
#include "core/optics/projection.h"
#include "core/sky/stars/star_counts.h"
#include "sensors/light/row_window.h"
#include "sensors/light/star_order.h"
#include "sensors/light/star_snapshots.h"
#include "sensors/scene/throughput.h"
#include "sensors/sky/star_exposure.h"

namespace dmise {
namespace {

/// Stars that are drawn at a time: what is known of them stays in the cache, and is too small for
/// memory of its own.
constexpr std::size_t stars_at_a_time = 512;

/// So many stars of a large catalogue are placed by a grid over the detector; fewer, and those of
/// small catalogues, one by one.
constexpr std::size_t least_for_grid = 8192;

/// Share of the light of the faintest source that matters, which has ten times a pixel's noise: the
/// paths of stars that a grid placed may be summed so roughly, in a pixel.
constexpr double missed_share = 1e-4;

/// The arc of a number, or those of its spectrum where `spread` makes them of it.
template <class Spread>
void spectrum_of(std::span<const Arc> arcs, std::size_t i, const Spread& spread,
                 std::vector<Arc>& whole) {
  whole.clear();
  if (spread)
    spread(i, whole);
  else
    whole.push_back(arcs[i]);
}

/// Deposits arcs, each as far as it is not behind something, as spectra where `spread` makes them
/// of an arc's number.
template <class Spread>
std::vector<Deposited> add_past(const OcclusionMask& mask, std::span<const Arc> arcs,
                                const Spread& spread, OpticsStage& optics,
                                ExpectedElectronImage& image, DepositSums sums) {
  if (mask.empty() && !spread) return optics.add(arcs, image, sums);
  std::vector<Arc> free;
  std::vector<std::size_t> star;
  std::vector<Arc> whole;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    spectrum_of(arcs, i, spread, whole);
    for (const Arc& part : mask.empty() ? whole : mask.past(whole)) {
      free.push_back(part);
      star.push_back(i);
    }
  }
  std::vector<Deposited> deposited(arcs.size());
  const auto parts = optics.add(free, image, sums);
  for (std::size_t k = 0; k < parts.size(); ++k) deposited[star[k]] = deposited[star[k]] + parts[k];
  return deposited;
}

/// Deposits snapshots of arcs at even times of each, as spectra where `spread` makes them.
template <class Spread>
std::vector<Deposited> add_snapshots(const View& view, std::span<const Arc> arcs, int count,
                                     const Spread& spread, OpticsStage& optics,
                                     const OcclusionMask& mask, ExpectedElectronImage& image) {
  std::vector<Deposited> deposited;
  std::vector<Arc> whole;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    spectrum_of(arcs, i, spread, whole);
    std::vector<Arc> points = as_snapshots(whole, count);
    for (Arc& point : points) point.signal_e *= view.illumination(point.middle);
    Deposited star;
    for (const Deposited& part : optics.add(mask.empty() ? points : mask.past(points), image))
      star = star + part;
    deposited.push_back(star);
  }
  return deposited;
}

}  // namespace

StarLayer::StarLayer(const SensorConfig& sensor, std::shared_ptr<const StarMap> map,
                     double faintest_v_mag)
    : field_(sensor, std::move(map), faintest_v_mag), light_(sensor.camera.band) {}

std::uint32_t StarLayer::draw(const View& view, OpticsStage& optics, const OcclusionMask& mask,
                              ExpectedElectronImage& image, double faintest_v_mag,
                              std::vector<StarTruth>* truth, EffectTimes& times) const {
  const StarMap& map = *field_.map();
  StarExposure exposure{.view = view, .map = map};
  std::vector<std::uint32_t> found = field_.candidates(view, faintest_v_mag);
  const int snapshots = view.sensor().effects.snapshots();
  const bool by_grid = !map.is_small() && found.size() >= least_for_grid && snapshots == 0;
  if (by_grid) {
    exposure.make_grid();
    order_for_drawing(found, map.index.direction, exposure.camera[1], view.sensor().camera.optics,
                      widest_shift_rad + turned_rad(view));
  }
  // OpenGL may draw snapshots, and its pictures are read back whole: all stars go at once.
  const std::size_t at_a_time =
      snapshots ? std::max<std::size_t>(1, found.size()) : stars_at_a_time;
  std::uint32_t inside = 0;
  for (std::size_t begin = 0; begin < found.size(); begin += at_a_time) {
    const auto which = std::span(found).subspan(begin, std::min(at_a_time, found.size() - begin));
    inside +=
        draw(exposure,
             by_grid ? exposure.trails_by_grid(which, map.index.direction) : exposure.trails(which),
             by_grid ? missed_share * optics.limit_e() : 0.0, optics, mask, image, truth, times);
  }
  const SyntheticStars* synthetic = field_.synthetic();
  if (!synthetic || faintest_v_mag < synthetic->from_v_mag()) return inside;
  double drawing_s = 0.0;
  const double before_s = times.sum_s();
  {
    Stopwatch timing(drawing_s);
    inside += draw_synthetic(*synthetic, exposure, optics, mask, image, truth, times);
  }
  times[SyntheticBackground::facts] += std::max(0.0, drawing_s - (times.sum_s() - before_s));
  return inside;
}

std::uint32_t StarLayer::draw_synthetic(const SyntheticStars& synthetic, StarExposure& exposure,
                                        OpticsStage& optics, const OcclusionMask& mask,
                                        ExpectedElectronImage& image, std::vector<StarTruth>* truth,
                                        EffectTimes& times) const {
  const EffectSet& effects = exposure.view.sensor().effects;
  const double limit = field_.synthetic_limit_v_mag(effects);
  const auto [axis, radius_rad] = exposure.seen_cone();
  if (synthetic.expected_around(axis, radius_rad, limit) >= double(least_for_grid))
    exposure.make_grid();
  std::uint32_t inside = 0;
  const auto draw_some = [&](const SyntheticStars::Stars& stars) {
    const StarExposure::Paths paths = exposure.paths(stars.direction);
    std::vector<StarTrail> trails;
    for (std::size_t i = 0; i < stars.id.size(); ++i) {
      if (!paths.is_there[i]) continue;
      const StarPath& at = paths.path[i];
      trails.push_back({.id = stars.id[i],
                        .number = std::uint32_t(stars.id[i] ^ stars.id[i] >> 31),
                        .v_mag = stars.v_mag[i],
                        .bv = stars.bv[i],
                        .middle = at.middle,
                        .pixel = at.pixel,
                        .airmass = at.airmass,
                        .illumination = at.illumination,
                        .astrometric = stars.direction[i]});
    }
    inside += draw(exposure, std::move(trails), missed_share * optics.limit_e(), optics, mask,
                   image, truth, times);
  };
  if (effects.snapshots())  // all at once, as in `draw`
    draw_some(synthetic.around(axis, radius_rad, limit));
  else
    synthetic.visit(axis, radius_rad, limit, draw_some);
  return inside;
}

/// Electrons of stars over the exposure behind the air and before vignetting.
std::vector<double> StarLayer::signals_e(const StarExposure& exposure,
                                         const std::vector<StarTrail>& trails,
                                         EffectTimes& times) const {
  std::vector<double> signal_e(trails.size());
  const double electrons_per_rate =
      exposure.throughput.electrons_per_photon_m2() * exposure.times.seconds();
  if (trails.empty() || !trails[0].airmass) {
    const auto factor_of_air = exposure.factors_of_air(trails, times);
    for (std::size_t i = 0; i < trails.size(); ++i)
      signal_e[i] = light_.photons_per_s_m2(trails[i].v_mag, {trails[i].bv, trails[i].kind}) *
                    electrons_per_rate * factor_of_air[i];
    return signal_e;
  }
  std::vector<double> v_mag(trails.size()), bv(trails.size());
  for (std::size_t i = 0; i < trails.size(); ++i) {
    v_mag[i] = trails[i].v_mag;
    bv[i] = trails[i].bv;
  }
  light_.photons_per_s_m2(v_mag, bv, signal_e);
  for (std::size_t i = 0; i < trails.size(); ++i)
    if (trails[i].kind != StarKind::most)
      signal_e[i] = light_.photons_per_s_m2(v_mag[i], {bv[i], trails[i].kind});
  for (double& signal : signal_e) signal *= electrons_per_rate;
  exposure.apply_air(trails, bv, signal_e, times);
  return signal_e;
}

std::uint32_t StarLayer::draw(const StarExposure& exposure, std::vector<StarTrail> trails,
                              double may_miss_e, OpticsStage& optics, const OcclusionMask& mask,
                              ExpectedElectronImage& image, std::vector<StarTruth>* truth,
                              EffectTimes& times) const {
  const View& view = exposure.view;
  {
    Stopwatch timing(times[EarthOccultation::facts]);
    std::erase_if(trails, [&](const StarTrail& t) { return exposure.hides(t.middle); });
  }
  const std::vector<double> signal_e = signals_e(exposure, trails, times);
  const int snapshots = view.sensor().effects.snapshots();
  const bool in_snapshots = snapshots > 0;
  std::vector<Arc> arcs;
  arcs.reserve(trails.size());
  for (std::size_t i = 0; i < trails.size(); ++i) {
    const auto& t = trails[i];
    arcs.push_back({t.pixel[0], t.pixel[1], t.pixel[2],
                    signal_e[i] * (in_snapshots     ? 1.0
                                   : t.illumination ? *t.illumination
                                                    : view.illumination(t.pixel[1])),
                    0.0, may_miss_e});
  }
  if (view.rolls())
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      arcs[i] = rolled(view, arcs[i]);
      trails[i].pixel = {arcs[i].start, arcs[i].middle, arcs[i].end};
    }
  std::function<void(std::size_t, std::vector<Arc>&)> spread;
  if (exposure.spectra)
    spread = [&](std::size_t i, std::vector<Arc>& parts) {
      exposure.spread(arcs[i], trails[i], parts);
    };
  std::vector<Deposited> deposited;
  if (in_snapshots && view.rolls()) {
    deposited = add_snapshots(view, arcs, snapshots, spread, optics, mask, image);
  } else if (in_snapshots) {
    deposited =
        draw_star_snapshots(view, exposure.columns, trails, signal_e, snapshots,
                            exposure.spectra ? &*exposure.spectra : nullptr, optics, mask, image);
  } else {
    deposited =
        add_past(mask, arcs, spread, optics, image, truth ? DepositSums::all : DepositSums::cut);
  }
  std::uint32_t inside = 0;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (deposited[i].signal_e <= 0.0) continue;
    ++inside;
    const StarTrail& t = trails[i];
    if (truth)
      truth->push_back({t.id, t.v_mag, t.bv, deposited[i].x_px, deposited[i].y_px,
                        deposited[i].signal_e, t.pixel[0], t.pixel[1], t.pixel[2]});
  }
  return inside;
}

}  // namespace dmise
