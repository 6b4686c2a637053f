#include "sensors/objects/object_sampler.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/frames/geodesy.h"
#include "core/optics/projection.h"
#include "core/photometry/magnitude.h"

namespace dmise {

ObjectSampler::ObjectSampler(const View& view, const ObjectShapes* shapes)
    : view_(view),
      shapes_(shapes),
      throughput_(view),
      spectra_(Spectra::over(view)),
      with_secondary_(has_secondary_light(view)),
      zero_mag_(object_photons_per_s_m2(0.0, view.sensor().camera.band)) {
  if (acts<EarthShadow>(view.sensor().effects, view.scene()))
    shadow_.emplace(view.environment().sun_m, view.surface(),
                    EarthShadow::Edge(view.sensor().effects.level(EarthShadow::facts)),
                    view.sensor().camera.band);
}

namespace {

/// How fast an object moves over the sky of an observer on the ground.
double rate_rad_per_s(const Motion& motion, const ObserverState& observer) {
  const Vec<Gcrs> spin{0, 0, earth_turn_rad_per_s};  // the pole is z to 0.1 deg
  const Vec<Gcrs> line_m = motion.position_m - observer.position_m;
  const Vec<Gcrs> passing_m_per_s =
      motion.slope_m_per_s - observer.velocity_m_per_s - cross(spin, line_m);
  return norm(cross(passing_m_per_s, line_m)) / std::max(dot(line_m, line_m), 1.0);
}

}  // namespace

ObjectSample ObjectSampler::sample(std::size_t object, const ExposureInstant& at) const {
  const Motion motion = view_.states().motion(object, at.time);
  const auto place = at.places.satellite(motion.position_m, motion.slope_m_per_s);
  ObjectSample s;
  s.pixel = project(view_.sensor().camera.optics, at.camera * place.direction);
  if (spectra_ && s.pixel)
    s.ends = spectra_->ends(place.direction, place.range_m, view_.up(at.time), at.camera, *s.pixel);
  s.sunlit = shadow_ ? shadow_->sunlit_fraction(motion.position_m) : 1.0;
  const bool hidden = at.earth && at.earth->hides_object(motion.position_m, place.direction);
  const ObjectShape* own_shape = shape(object);
  const double burning = reentry_light(object, motion, at);
  if (hidden || (s.sunlit <= 0.0 && !own_shape && !with_secondary_ && burning <= 0.0)) return s;
  s.electrons_per_photon_m2 =
      throughput_.of_air({place.direction, sun_bv, SightLine::Source::object,
                          view_.states().roster().objects[object].catalogue_number,
                          rate_rad_per_s(motion, at.observer), std::nullopt, place.range_m}) *
      throughput_.electrons_per_photon_m2() * (s.pixel ? view_.illumination(*s.pixel) : 1.0);
  const double photons =
      own_shape ? shape_photons(object, *own_shape, at.time, at.observer, s.sunlit)
                : zero_mag_ * light_of_magnitude(magnitude(object, motion, at)) * s.sunlit +
                      zero_mag_ * burning + secondary_photons(object, motion, at);
  s.electrons_per_s = photons * s.electrons_per_photon_m2;
  return s;
}

Illumination ObjectSampler::illumination(const Motion& motion, const Vec<Gcrs>& observer_m) const {
  const Vec<Gcrs> to_sun = view_.environment().sun_m - motion.position_m;
  const Vec<Gcrs> to_observer = observer_m - motion.position_m;
  return {.range_m = norm(to_observer),
          .phase_rad = angle_rad(to_sun, to_observer),
          .sun_distance_au = norm(to_sun) / au_m};
}

double ObjectSampler::magnitude(std::size_t object, const Motion& motion,
                                const ExposureInstant& at) const {
  if (const ObjectShape* own_shape = shape(object))
    if (const auto pose = shape_pose(view_, object, at.time, at.observer.position_m, 0))
      return shape_magnitude(*own_shape, *pose);
  return diffuse_sphere_magnitude(sphere(object, at.time),
                                  illumination(motion, at.observer.position_m));
}

double ObjectSampler::magnitude_of_all_light(std::size_t object, const Motion& motion,
                                             const ExposureInstant& at) const {
  if (!with_secondary_ && !reentry(object)) return magnitude(object, motion, at);
  if (const ObjectShape* own_shape = shape(object))
    if (const auto pose = shape_pose(view_, object, at.time, at.observer.position_m))
      return shape_magnitude(*own_shape, *pose);
  const double light = light_of_magnitude(magnitude(object, motion, at)) +
                       reentry_light(object, motion, at) +
                       secondary_photons(object, motion, at) / zero_mag_;
  return light > 0.0 ? std::min(darkest_mag, magnitude_of_light(light)) : darkest_mag;
}

DiffuseSphere ObjectSampler::sphere(std::size_t object, SimTime t) const {
  DiffuseSphere sphere = view_.states().roster().objects[object].sphere;
  if (const auto albedo = view_.states().albedo(object, t)) sphere.albedo = *albedo;
  return sphere;
}

const ObjectShape* ObjectSampler::shape(std::size_t object) const {
  return shapes_ ? shapes_->of(view_.states().roster().objects[object]) : nullptr;
}

const ReentryLight* ObjectSampler::reentry(std::size_t object) const {
  return shapes_ ? shapes_->reentry_of(view_.states().roster().objects[object].catalogue_number)
                 : nullptr;
}

double ObjectSampler::reentry_light(std::size_t object, const Motion& motion,
                                    const ExposureInstant& at) const {
  const ReentryLight* light = reentry(object);
  if (!light) return 0.0;
  const Vec<Itrs> place_m = view_.earth().itrs_from_gcrs(at.time) * motion.position_m;
  const double ranges = light->range_m / norm(motion.position_m - at.observer.position_m);
  return light->at(geodetic_from_itrs(place_m, view_.sensor().ellipsoid).height_m) * ranges *
         ranges;
}

double ObjectSampler::shape_photons(std::size_t object, const ObjectShape& shape, SimTime t,
                                    const ObserverState& observer, double sunlit, int rings) const {
  const auto pose = shape_pose(view_, object, t, observer.position_m, rings);
  return pose ? shape_photons_per_s_m2(*shapes_, shape, *pose, sunlit) : 0.0;
}

double ObjectSampler::secondary_photons(std::size_t object, const Motion& motion,
                                        const ExposureInstant& at) const {
  if (!with_secondary_) return 0.0;
  const DiffuseSphere sphere = this->sphere(object, at.time);
  Rotation<Body, Gcrs> axes;  // a sphere looks the same in any
  const Illumination seen = illumination(motion, at.observer.position_m);
  const Vec<Body> to_viewer = axes * unit(at.observer.position_m - motion.position_m);
  double light = 0.0;
  for (const auto& source : secondary_light_on(view_, motion.position_m, axes))
    light += diffuse_sphere_light(sphere, {.range_m = seen.range_m,
                                           .phase_rad = angle_rad(source.to_source, to_viewer),
                                           .sun_distance_au = seen.sun_distance_au,
                                           .sunlit = source.share});
  return zero_mag_ * light_of_magnitude(sun_v_mag) * light;
}

std::vector<Arc> arcs_of(const std::vector<ObjectSample>& samples, double seconds) {
  std::vector<Arc> arcs;
  const std::size_t count = (samples.size() - 1) / 2;
  const double arc_s = seconds / double(count);
  for (std::size_t k = 0; k < count; ++k) {
    const ObjectSample &a = samples[2 * k], &m = samples[2 * k + 1], &b = samples[2 * k + 2];
    if (!a.pixel || !m.pixel || !b.pixel) continue;
    const double mean = (a.electrons_per_s + 4 * m.electrons_per_s + b.electrons_per_s) / 6;
    if (mean <= 0.0) continue;
    const double tilt = std::clamp((b.electrons_per_s - a.electrons_per_s) / (2 * mean), -1.0, 1.0);
    arcs.push_back({*a.pixel, *m.pixel, *b.pixel, mean * arc_s, tilt});
  }
  return arcs;
}

double distance_px(const ObjectSample& a, const ObjectSample& b) {
  return a.pixel && b.pixel
             ? std::hypot(a.pixel->x_px - b.pixel->x_px, a.pixel->y_px - b.pixel->y_px)
             : 1e9;
}

}  // namespace dmise
