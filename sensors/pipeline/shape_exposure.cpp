#include "sensors/pipeline/shape_exposure.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

/// Gives each arc of an object with a shape the mean of its brightness, so that a glint shorter
/// than an arc is not missed, in steps in which it turns by no more than `still_enough_rad`.
void integrate_glints(const View& view, const ObjectSampler& sampler, std::size_t object,
                      const std::vector<ObjectSample>& samples, std::vector<Arc>& arcs) {
  const auto& exposure = view.times();
  const double arc_s = exposure.seconds() / double(arcs.size());
  const double turn = turn_rad(view, object) / double(arcs.size());
  const int halves = 2 * std::clamp(int(std::ceil(turn / still_enough_rad / 2)), 1, 256);
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    const ObjectSample& middle = samples[2 * k + 1];
    double half[2] = {};
    for (int i = 0; i < halves; ++i) {
      const SimTime t = exposure.at((double(k) + (i + 0.5) / halves) / double(arcs.size()));
      half[2 * i / halves] +=
          sampler.shape_photons(object, *sampler.shape(object), t, view.observer(t), middle.sunlit);
    }
    const double sum = half[0] + half[1];
    arcs[k].signal_e = sum / halves * middle.electrons_per_photon_m2 * arc_s;
    arcs[k].tilt = sum > 0.0 ? std::clamp(2 * (half[1] - half[0]) / sum, -1.0, 1.0) : 0.0;
  }
}

}  // namespace

std::vector<Arc> shape_arcs(const View& view, const ObjectSampler& sampler, std::size_t object,
                            const std::vector<ObjectSample>& samples) {
  std::vector<ObjectSample> path = samples;
  for (ObjectSample& s : path) s.electrons_per_s = s.pixel ? 1.0 : 0.0;
  std::vector<Arc> arcs = arcs_of(path, view.times().seconds());
  if (2 * arcs.size() + 1 != samples.size())  // a part has no place in the image
    return arcs_of(samples, view.times().seconds());
  integrate_glints(view, sampler, object, samples, arcs);
  return arcs;
}

std::vector<ShapeSnapshot> snapshots_of(const View& view, const ObjectSampler& sampler,
                                        std::size_t object,
                                        const std::vector<ObjectSample>& samples) {
  constexpr int most = 32;
  const auto& exposure = view.times();
  const ObjectShape& shape = *sampler.shape(object);
  double path_px = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i)
    path_px += distance_px(samples[i - 1], samples[i]);
  const ExposureInstant middle(view, exposure.middle);
  const double range_m =
      norm(view.world().motion(object, exposure.middle).position_m - middle.observer.position_m);
  const double radius_px = shape.radius_m / range_m / view.sensor().camera.optics.pixel_angle_rad();
  const double swept_px = path_px + radius_px * turn_rad(view, object);
  const int count = std::clamp(int(std::ceil(2 * std::min(swept_px, 1e6))), 1, most);
  std::vector<ShapeSnapshot> snapshots;
  for (int i = 0; i < count; ++i) {
    const ExposureInstant at(view, exposure.at((i + 0.5) / count));
    const auto pose = shape_pose(view, object, at.time, at.observer.position_m);
    if (!pose) continue;
    const Motion motion = view.world().motion(object, at.time);
    const auto place = at.places.satellite(motion.position_m, motion.slope_m_per_s);
    const ObjectSample sample = sampler.sample(object, at);
    snapshots.push_back({.shape = &shape,
                         .pose = *pose,
                         .camera_from_gcrs = at.camera,
                         .direction = unit(at.camera * place.direction),
                         .sunlit = sample.sunlit,
                         .electrons_per_photon_m2 = sample.electrons_per_photon_m2,
                         .seconds = exposure.seconds() / count});
  }
  return snapshots;
}

}  // namespace dmise
