#include "sensors/light/shape_exposure.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

/// Light of one arc.
struct ArcLight {
  double signal_e = 0.0, tilt = 0.0;
  SimTime brightest;    // instant with the most light among those summed
  double most = 0.0;    // photons/s/m2 then
  double sunlit = 0.0;  // for those
};

/// By how many times of what keeps the light of its glints the bisector turns; 0 without them.
double turn_of_glints(const View& view, const ObjectSampler& sampler, std::size_t object,
                      double begin = 0.0, double end = 1.0) {
  const auto& glints = sampler.shape(object)->glints;
  return glints ? bisector_turn_rad(view, object, begin, end) / glints->still_rad() : 0.0;
}

/// The mean brightness of a shape over arc `k` of `count`, in steps in which it keeps its light, so
/// that a glint shorter than an arc is not missed. Where those are too many each instant is
/// elsewhere in its step, by the golden ratio: whatever the rotation's period, the instants of all
/// arcs together look at all its phases evenly.
ArcLight light_of_arc(const View& view, const ObjectSampler& sampler, std::size_t object,
                      const ObjectSample& middle, std::size_t k, std::size_t count) {
  const auto& exposure = view.times();
  constexpr double max_halves = 256.0, golden = 0.6180339887498949;
  const double begin = double(k) / double(count), end = double(k + 1) / double(count);
  const double turn = std::max(turn_rad(view, object, begin, end) / still_enough_rad,
                               turn_of_glints(view, sampler, object, begin, end));
  const double wanted = std::max(1.0, std::ceil(turn / 2));
  const bool few = wanted > max_halves;
  const int halves = 2 * int(std::min(wanted, max_halves));
  const auto within = [&](int i) {
    const double n = double(k) * halves + i;
    return few ? n * golden - std::floor(n * golden) : 0.5;
  };
  const ObjectShape& shape = *sampler.shape(object);
  const auto at = [&](double part) { return exposure.at((double(k) + part) / double(count)); };
  double half[2] = {};
  ArcLight light{.sunlit = middle.sunlit};
  for (int i = 0; i < halves; ++i) {
    const SimTime t = at((i + within(i)) / halves);
    const double photons =
        sampler.shape_photons(object, shape, t, view.observer(t), middle.sunlit, 0);
    half[2 * i / halves] += photons;
    if (photons > light.most) {
      light.most = photons;
      light.brightest = t;
    }
  }
  double sum = half[0] + half[1];
  light.tilt = sum > 0.0 ? std::clamp(2 * (half[1] - half[0]) / sum, -1.0, 1.0) : 0.0;
  if (has_secondary_light(view)) {
    const SimTime t = at(0.5);
    const auto pose = shape_pose(view, object, t, view.observer(t).position_m);
    if (pose) sum += halves * secondary_photons_per_s_m2(sampler.shapes(), shape, *pose);
  }
  light.signal_e =
      sum / halves * middle.electrons_per_photon_m2 * exposure.seconds() / double(count);
  return light;
}

Vec<CameraFrame> direction_at(const View& view, std::size_t object, const ExposureInstant& at) {
  const Motion motion = view.states().motion(object, at.time);
  return unit(at.camera * at.places.satellite(motion.position_m, motion.slope_m_per_s).direction);
}

/// One arc for several that follow one another, of equal time.
Arc joined(std::span<const Arc> arcs) {
  const std::size_t half = arcs.size() / 2;
  Arc all{arcs.front().start, arcs.size() % 2 ? arcs[half].middle : arcs[half].start,
          arcs.back().end, 0.0, 0.0};
  double late = 0.0;  // second half less the first
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    all.signal_e += arcs[i].signal_e;
    if (arcs.size() % 2 && i == half)
      late += arcs[i].tilt / 2 * arcs[i].signal_e;
    else
      late += i < half ? -arcs[i].signal_e : arcs[i].signal_e;
  }
  if (all.signal_e > 0.0) all.tilt = std::clamp(2.0 * late / all.signal_e, -1.0, 1.0);
  return all;
}

/// Short ways of even light are one arc.
std::vector<Arc> simplified(std::vector<Arc> arcs) {
  constexpr double short_px = 8.0, even = 0.5;
  double way_px = 0.0, min_e = arcs[0].signal_e, max_e = min_e;
  for (const Arc& arc : arcs) {
    way_px += length_px(arc);
    min_e = std::min(min_e, arc.signal_e);
    max_e = std::max(max_e, arc.signal_e);
  }
  constexpr double still_px = 1e-3;
  if (way_px < still_px)
    for (Arc& arc : arcs) arc.start = arc.end = arc.middle;
  if (way_px < still_px || (way_px < short_px && min_e >= even * max_e)) return {joined(arcs)};
  return arcs;
}

/// The instant of the brightest pose within a part of the exposure; its middle, unless another is
/// twice as bright. `lights`: of the arcs of that part, whose instants are closer.
SimTime brightest(const View& view, const ObjectSampler& sampler, std::size_t object, double begin,
                  double end, const std::vector<ArcLight>& lights) {
  const SimTime middle = view.times().at((begin + end) / 2);
  if (turn_rad(view, object, begin, end) < still_enough_rad) return middle;
  constexpr int looks = 16;
  const auto light = [&](SimTime t, double sunlit = 1.0) {
    return sampler.shape_photons(object, *sampler.shape(object), t, view.observer(t), sunlit, 0);
  };
  SimTime best = middle;
  double most = 2.0 * light(middle);
  for (int i = 0; i < looks; ++i) {
    const SimTime t = view.times().at(begin + (end - begin) * (i + 0.5) / looks);
    if (const double l = light(t); l > most) {
      most = l;
      best = t;
    }
  }
  constexpr double missed = 100.0;  // a glint between the looks is brighter than they
  for (const ArcLight& arc : lights)
    if (arc.most > missed * light(best, arc.sunlit)) best = arc.brightest;
  return best;
}

}  // namespace

std::size_t arcs_for_light(const View& view, const ObjectSampler& sampler, std::size_t object,
                           std::size_t arcs, std::size_t most) {
  if (turn_rad(view, object) > still_enough_rad) return most;
  const double turn = turn_of_glints(view, sampler, object);
  while (double(arcs) < turn && arcs < most) arcs *= 2;
  return arcs;
}

std::vector<Arc> shape_arcs(const View& view, const ObjectSampler& sampler, std::size_t object,
                            const std::vector<ObjectSample>& samples) {
  std::vector<ObjectSample> path = samples;
  for (ObjectSample& s : path) s.electrons_per_s = s.pixel ? 1.0 : 0.0;
  std::vector<Arc> arcs = arcs_of(path, view.times().seconds());
  if (2 * arcs.size() + 1 != samples.size())  // a part has no place in the image
    return arcs_of(samples, view.times().seconds());
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    const auto light = light_of_arc(view, sampler, object, samples[2 * k + 1], k, arcs.size());
    arcs[k].signal_e = light.signal_e;
    arcs[k].tilt = light.tilt;
  }
  return arcs;
}

int poses_of(const View& view, const ObjectSampler& sampler, std::size_t object) {
  const auto& exposure = view.times();
  const auto line_m = [&](SimTime t) {
    return view.states().motion(object, t).position_m - view.observer(t).position_m;
  };
  const Vec<Gcrs> start_m = line_m(exposure.start), end_m = line_m(exposure.end);
  const double nearest_m = std::min({norm(start_m), norm(end_m), norm(line_m(exposure.middle))});
  const double radius_px =
      sampler.shape(object)->radius_m / nearest_m / view.sensor().camera.optics.pixel_angle_rad();
  const double change = turn_rad(view, object) + angle_rad(start_m, end_m) +
                        std::abs(norm(start_m) - norm(end_m)) / nearest_m;
  return int(std::clamp(std::ceil(2.0 * radius_px * change), 1.0, double(max_poses)));
}

std::vector<ShapeSnapshot> snapshots_of(const View& view, const ObjectSampler& sampler,
                                        std::size_t object,
                                        const std::vector<ObjectSample>& samples, int poses) {
  const std::size_t count = (samples.size() - 1) / 2;
  const bool placed = std::all_of(samples.begin(), samples.end(),
                                  [](const ObjectSample& s) { return s.pixel.has_value(); });
  std::vector<ShapeSnapshot> snapshots;
  for (int pose = 0; pose < poses; ++pose) {
    const std::size_t first = count * std::size_t(pose) / std::size_t(poses);
    const std::size_t last = count * (std::size_t(pose) + 1) / std::size_t(poses);
    const double begin = double(first) / double(count), end = double(last) / double(count);
    std::vector<ArcLight> lights;
    for (std::size_t k = first; k < last; ++k)
      lights.push_back(light_of_arc(view, sampler, object, samples[2 * k + 1], k, count));
    const ExposureInstant at(view, brightest(view, sampler, object, begin, end, lights));
    auto shape_at =
        shape_pose(view, object, at.time, at.observer.position_m, earthshine_picture_rings);
    if (!shape_at) continue;
    const ObjectSample sample = sampler.sample(object, at);
    ShapeSnapshot snapshot{.shape = sampler.shape(object),
                           .pose = std::move(*shape_at),
                           .camera_from_gcrs = at.camera,
                           .direction = direction_at(view, object, at),
                           .sunlit = sample.sunlit,
                           .photons_per_s_m2 = 0.0,
                           .sweep = {},
                           .share = end - begin};
    for (std::size_t k = first; k < last; ++k) {
      const ArcLight& light = lights[k - first];
      Arc arc{{}, {}, {}, light.signal_e, light.tilt};
      if (placed && sample.pixel)
        for (const auto& [place, i] : {std::pair(&arc.start, 0), {&arc.middle, 1}, {&arc.end, 2}})
          *place = *samples[2 * k + std::size_t(i)].pixel - *sample.pixel;
      snapshot.sweep.push_back(arc);
    }
    const bool shines = std::any_of(snapshot.sweep.begin(), snapshot.sweep.end(),
                                    [](const Arc& arc) { return arc.signal_e > 0.0; });
    if (!shines && !(sample.electrons_per_photon_m2 > 0.0)) continue;  // behind the Earth
    // Where the pose is dark but not its part of the exposure the shape is that of full sunlight.
    snapshot.photons_per_s_m2 =
        facet_photons_per_s_m2(sampler.shapes(), *snapshot.shape, snapshot.pose, snapshot.sunlit);
    if (shines && !(snapshot.photons_per_s_m2 > 0.0)) {
      snapshot.sunlit = 1.0;
      snapshot.photons_per_s_m2 =
          facet_photons_per_s_m2(sampler.shapes(), *snapshot.shape, snapshot.pose, 1.0);
    }
    snapshot.sweep = simplified(std::move(snapshot.sweep));
    snapshots.push_back(std::move(snapshot));
  }
  return snapshots;
}

}  // namespace dmise
