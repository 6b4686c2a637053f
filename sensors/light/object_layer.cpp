#include "sensors/light/object_layer.h"

#include <algorithm>
#include <map>
#include <optional>

#include "core/base/error.h"
#include "core/effects/frame_effects.h"
#include "core/optics/blur/snapshots.h"
#include "core/optics/projection.h"
#include "sensors/light/row_window.h"
#include "sensors/light/shape_exposure.h"
#include "sensors/objects/object_sampler.h"
#include "sensors/render/resolution.h"

namespace dmise {
namespace {

bool inside(const std::optional<PixelPosition>& p, const Optics& optics) {
  return p && in_frame(optics, *p);
}

/// A path this long [px] is cut into arcs; shorter ones are one parabola to 1e-3 px.
constexpr double straight_enough_px = 8.0;
constexpr std::size_t plain_arcs = 1, curved_arcs = 16, changing_arcs = 128;

/// Brightness that changes by more than this over an arc has an edge in it: shadow, horizon.
constexpr double abrupt_ratio = 0.5;

bool changes_abruptly(const std::vector<ObjectSample>& samples) {
  double least = samples[0].electrons_per_s, most = least;
  for (const auto& s : samples) {
    least = std::min(least, s.electrons_per_s);
    most = std::max(most, s.electrons_per_s);
  }
  return least < abrupt_ratio * most;
}

/// By Simpson's rule: an odd number of samples at even times.
double mean_sunlit(const std::vector<ObjectSample>& samples) {
  double sum = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const bool at_end = k == 0 || k + 1 == samples.size();
    sum += samples[k].sunlit * (at_end ? 1.0 : k % 2 ? 4.0 : 2.0);
  }
  return sum / (3.0 * double(samples.size() - 1));
}

double range_m_of(const View& view, std::size_t object, const ExposureInstant& at) {
  return norm(view.states().motion(object, at.time).position_m - at.observer.position_m);
}

bool is_resolved_at(const View& view, const ObjectSampler& sampler, std::size_t object,
                    const ExposureInstant& at) {
  const ObjectShape* shape = sampler.shape(object);
  const int level = view.sensor().effects.level(ResolvedShapes::facts);
  return shape && is_resolved(shape->radius_m, range_m_of(view, object, at),
                              view.sensor().camera.optics.pixel_angle_rad(),
                              ResolvedShapes::tolerance_px[std::size_t(level)]);
}

Deposited draw_resolved(const View& view, const ObjectSampler& sampler, std::size_t object,
                        const std::vector<ShapeSnapshot>& snapshots, double defocus_m,
                        OpticsStage& stage, OcclusionMask& mask, ExpectedElectronImage& image) {
  try {
    return draw_shape(view, sampler.shapes(), snapshots, defocus_m, stage, mask, image);
  } catch (const Error& error) {
    throw Error("object " + view.states().roster().objects[object].name + ": " + error.what());
  }
}

/// Nearest first: what is drawn later lies behind it. Objects of one range as they are listed.
std::vector<std::size_t> nearest_first(const View& view, std::vector<std::size_t> objects,
                                       const ExposureInstant& at) {
  std::map<std::size_t, double> range_m;
  for (const std::size_t object : objects) range_m[object] = range_m_of(view, object, at);
  std::stable_sort(objects.begin(), objects.end(),
                   [&](std::size_t a, std::size_t b) { return range_m.at(a) < range_m.at(b); });
  return objects;
}

/// The arcs of an object with their light spread along the vertical. `arcs` are of `samples`.
std::vector<Arc> spread(const View& view, const ObjectSampler& sampler, std::size_t object,
                        std::vector<ObjectSample> samples, const std::vector<Arc>& arcs,
                        const ExposureInstant& middle) {
  const int count = view.sensor().effects.snapshots();
  // The light of an object with a shape is not that of its samples: any gives the path.
  const bool is_whole = std::all_of(samples.begin(), samples.end(),
                                    [](const auto& s) { return s.pixel.has_value(); });
  if (sampler.shape(object) && is_whole)
    for (auto& s : samples) s.electrons_per_s = 1.0;
  const auto path = [&](PixelPosition SpectrumEnds::*end) {
    for (auto& s : samples)
      if (s.pixel) s.pixel = (*s.ends).*end;
    const auto whole = arcs_of(samples, view.times().seconds());
    return count ? as_snapshots(whole, count) : whole;
  };
  const auto blue = path(&SpectrumEnds::blue), red = path(&SpectrumEnds::red);
  if (blue.size() != arcs.size()) return arcs;
  const Motion motion = view.states().motion(object, middle.time);
  const auto place = middle.places.satellite(motion.position_m, motion.slope_m_per_s);
  std::vector<Arc> parts;
  for (std::size_t i = 0; i < arcs.size(); ++i)
    sampler.spectra()->add(arcs[i], blue[i], red[i], place.direction, sun_bv, parts);
  return parts;
}

std::vector<Truth> paint(const View& view, const ObjectSampler& sampler,
                         const std::vector<std::size_t>& objects, OpticsStage& stage,
                         OcclusionMask& mask, ExpectedElectronImage& image) {
  const auto& exposure = view.times();
  const auto& optics = view.sensor().camera.optics;
  // Instants of the finest division; a coarser one uses some of them.
  std::vector<std::optional<ExposureInstant>> instants(2 * changing_arcs + 1);
  const auto instant = [&](std::size_t k) -> const ExposureInstant& {
    if (!instants[k])
      instants[k].emplace(view, exposure.at(double(k) / double(instants.size() - 1)));
    return *instants[k];
  };
  const auto samples_of = [&](std::size_t object, std::size_t arcs) {
    std::vector<ObjectSample> samples;
    const std::size_t step = changing_arcs / arcs;
    for (std::size_t k = 0; k < instants.size(); k += step)
      samples.push_back(sampler.sample(object, instant(k)));
    return samples;
  };

  const EffectSet& effects = view.sensor().effects;
  const int level =
      acts<RangeDefocus>(effects, view.scene()) ? effects.level(RangeDefocus::facts) : 0;
  std::map<std::size_t, Truth> truth_of;  // by object
  std::optional<ApparentPlaces> true_places;
  for (const std::size_t object : nearest_first(view, objects, instant(changing_arcs))) {
    std::vector<ObjectSample> samples = samples_of(object, plain_arcs);
    const ObjectSample start = samples[0], middle = samples[1], end = samples[2];
    if (distance_px(start, middle) + distance_px(middle, end) > straight_enough_px)
      samples = samples_of(object, curved_arcs);
    if (sampler.reentry(object) || changes_abruptly(samples))
      samples = samples_of(object, changing_arcs);
    Deposited light;
    const double defocus_m =
        stage.defocus_at_m(range_m_of(view, object, instant(changing_arcs)), level);
    const bool resolved = is_resolved_at(view, sampler, object, instant(changing_arcs));
    const bool shaped = sampler.shape(object) != nullptr;
    if (shaped) {
      const std::size_t arcs = (samples.size() - 1) / 2;
      const std::size_t wanted = arcs_for_light(view, sampler, object, arcs, changing_arcs);
      if (wanted > arcs) samples = samples_of(object, wanted);
    }
    if (resolved) {
      const int poses = poses_of(view, sampler, object);
      if (std::size_t(2 * poses) >= samples.size()) samples = samples_of(object, changing_arcs);
      light =
          draw_resolved(view, sampler, object, snapshots_of(view, sampler, object, samples, poses),
                        defocus_m, stage, mask, image);
    } else {
      auto arcs = shaped ? shape_arcs(view, sampler, object, samples)
                         : arcs_of(samples, exposure.seconds());
      const int count = view.sensor().effects.snapshots();
      if (count) arcs = as_snapshots(arcs, count);
      if (sampler.spectra())
        arcs = spread(view, sampler, object, samples, arcs, instant(changing_arcs));
      arcs = mask.past(arcs);
      light = stage.add(arcs, defocus_m, image);
    }
    bool enters = false;
    for (const auto& s : samples) enters = enters || inside(s.pixel, optics);
    if (light.signal_e <= 0.0 && !enters) continue;

    const ExposureInstant& mid = instant(changing_arcs);
    const auto& facts = view.states().roster().objects[object];
    const Motion motion = view.states().motion(object, mid.time);
    if (!true_places) true_places.emplace(view.true_places(mid.time));
    const auto place = true_places->satellite(motion.position_m, motion.slope_m_per_s);
    const auto [ra, dec] = to_spherical(place.astrometric);
    const auto [apparent_ra, apparent_dec] = to_spherical(place.aberrated);
    Truth truth{.sensor = view.sensor().name,
                .frame = exposure.frame,
                .catalogue_number = facts.catalogue_number,
                .name = facts.name,
                .start = exposure.start,
                .middle = exposure.middle,
                .end = exposure.end,
                .true_position_m = motion.position_m,
                .true_velocity_m_per_s = motion.slope_m_per_s,
                .true_range_m = place.range_m,
                .true_ra_rad = ra,
                .true_dec_rad = dec,
                .apparent_ra_rad = apparent_ra,
                .apparent_dec_rad = apparent_dec,
                .phase_angle_rad = sampler.illumination(motion, mid.observer.position_m).phase_rad,
                .sunlit = mean_sunlit(samples),
                .true_magnitude = sampler.magnitude_of_all_light(object, motion, mid),
                .rendered_signal_e = light.signal_e,
                .rendered_x_px = light.x_px,
                .rendered_y_px = light.y_px,
                .in_frame = light.signal_e > 0.0,
                .whole = inside(start.pixel, optics) && inside(middle.pixel, optics) &&
                         inside(end.pixel, optics),
                .resolved = resolved,
                .defocus_disc_px = stage.disc_px(defocus_m)};
    if (view.on_ground())
      truth.true_elevation_rad =
          elevation_over(view.up(mid.time), unit(motion.position_m - mid.observer.position_m));
    const auto put = [](const ObjectSample& s, double& x, double& y) {
      if (s.pixel) {
        x = s.pixel->x_px;
        y = s.pixel->y_px;
      }
    };
    put(start, truth.start_x_px, truth.start_y_px);
    put(middle, truth.middle_x_px, truth.middle_y_px);
    put(end, truth.end_x_px, truth.end_y_px);
    if (view.errors().any()) truth.camera_from_gcrs = quaternion_of(mid.camera);
    truth_of.emplace(object, std::move(truth));
  }
  std::vector<Truth> truths;  // as listed
  for (const std::size_t object : objects)
    if (const auto found = truth_of.find(object); found != truth_of.end())
      truths.push_back(std::move(found->second));
  return truths;
}

/// Paints with a rolling shutter, which exposes each object in its own time.
std::vector<Truth> paint_rolled(const View& view, const std::vector<std::size_t>& objects,
                                const ObjectShapes* shapes, OpticsStage& stage, OcclusionMask& mask,
                                ExpectedElectronImage& image) {
  std::map<std::size_t, std::vector<Truth>> truth_of;
  const ExposureInstant middle(view, view.times_of_all_rows().middle);
  for (const std::size_t object : nearest_first(view, objects, middle)) {
    const auto row_at = [&](SimTime t) -> std::optional<double> {
      const ExposureInstant at(view, t);
      const Motion motion = view.states().motion(object, t);
      const auto place = at.places.satellite(motion.position_m, motion.slope_m_per_s);
      const auto pixel = project(view.sensor().camera.optics, at.camera * place.direction);
      return pixel ? std::optional(pixel->y_px) : std::nullopt;
    };
    const View own = view.during(row_window(view, row_at));
    truth_of[object] = paint(own, ObjectSampler(own, shapes), {object}, stage, mask, image);
  }
  std::vector<Truth> truths;  // as listed
  for (const std::size_t object : objects)
    for (Truth& truth : truth_of[object]) truths.push_back(std::move(truth));
  return truths;
}

}  // namespace

std::vector<Truth> draw_objects(const View& view, const std::vector<std::size_t>& objects,
                                const ObjectShapes* shapes, OpticsStage& optics,
                                OcclusionMask& mask, ExpectedElectronImage& image) {
  if (view.rolls()) return paint_rolled(view, objects, shapes, optics, mask, image);
  return paint(view, ObjectSampler(view, shapes), objects, optics, mask, image);
}

}  // namespace dmise
