#include "sensors/pipeline/object_layer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/units.h"
#include "core/optics/deposit.h"
#include "core/optics/projection.h"
#include "core/optics/snapshots.h"
#include "core/photometry/diffuse_sphere.h"
#include "core/photometry/magnitude.h"
#include "core/sky/shadow.h"
#include "sensors/pipeline/light.h"
#include "sensors/pipeline/place_costs.h"
#include "sensors/pipeline/shape_layer.h"
#include "sensors/pipeline/stopwatch.h"
#include "sensors/render/resolution.h"

namespace dmise {
namespace {

/// An object at one time of the exposure.
struct Sample {
  std::optional<PixelPosition> pixel;
  double electrons_per_s = 0.0;  // expected at the detector; 0 when dark or hidden
  double sunlit = 0.0;
  double electrons_per_photon_m2 = 0.0;  // of the way from above the atmosphere; 0 when hidden
};

/// One instant of the exposure with all that does not depend on the object.
struct Instant {
  SimTime time;
  ApparentPlaces places;
  Rotation<CameraFrame, Gcrs> camera;
  Hidden hidden;
  ObserverState observer;

  Instant(const View& view, SimTime t)
      : time(t),
        places(view.places(t)),
        camera(view.camera_from_gcrs(t)),
        hidden(view, t),
        observer(view.observer(t)) {}
};

class Painter {
 public:
  Painter(const View& view, const ObjectShapes* shapes, EffectTimes& times)
      : view_(view),
        shapes_(shapes),
        times_(times),
        light_(view),
        shadow_(view.environment().sun_m, oblate_earth(view.earth())),
        with_shadow_(view.sensor().effects.has(Effect::shadow)),
        zero_mag_(object_photons_per_s_m2(0.0, view.sensor().camera.band)) {}

  Sample sample(std::size_t object, const Instant& at) const {
    ++samples_;
    const Motion motion = view_.world().motion(object, at.time);
    const auto place = at.places.satellite(motion.position_m, motion.slope_m_per_s);
    Sample s;
    s.pixel = project(view_.sensor().camera.optics, at.camera * place.direction);
    {
      Stopwatch timing(times_[Effect::shadow]);
      s.sunlit = with_shadow_ ? shadow_.sunlit_fraction(motion.position_m) : 1.0;
    }
    bool hidden = false;
    {
      Stopwatch timing(times_[Effect::earth_occultation]);
      hidden = at.hidden.object(motion.position_m, place.direction);
    }
    const ObjectShape* own_shape = shape(object);
    if (hidden || (s.sunlit <= 0.0 && !own_shape)) return s;
    s.electrons_per_photon_m2 =
        transmission(place.direction) * flicker(object, place.direction) *
        light_.electrons_per_photon_m2() *
        (s.pixel ? relative_illumination(view_.sensor().camera.optics, *s.pixel) : 1.0);
    const double photons =
        own_shape ? shape_photons(object, *own_shape, at.time, at.observer, s.sunlit)
                  : zero_mag_ * light_of_magnitude(magnitude(object, motion, at)) * s.sunlit;
    s.electrons_per_s = photons * s.electrons_per_photon_m2;
    return s;
  }

  Illumination illumination(const Motion& motion, const Vec<Gcrs>& observer_m) const {
    const Vec<Gcrs> to_sun = view_.environment().sun_m - motion.position_m;
    const Vec<Gcrs> to_observer = observer_m - motion.position_m;
    return {.range_m = norm(to_observer),
            .phase_rad = angle_rad(to_sun, to_observer),
            .sun_distance_au = norm(to_sun) / au_m};
  }

  /// V above the atmosphere, fully lit.
  double magnitude(std::size_t object, const Motion& motion, const Instant& at) const {
    const auto& facts = view_.world().roster().objects[object];
    if (const ObjectShape* own_shape = shape(object))
      if (const auto pose = shape_pose(view_, object, at.time, at.observer.position_m))
        return shape_magnitude(*own_shape, *pose);
    const Illumination seen = illumination(motion, at.observer.position_m);
    return std::visit(
        [&](const DiffuseSphere& sphere) { return diffuse_sphere_magnitude(sphere, seen); },
        facts.geometry);
  }

  /// Null for an object without a shape.
  const ObjectShape* shape(std::size_t object) const {
    return shapes_ ? shapes_->of(view_.world().roster().objects[object].catalogue_number) : nullptr;
  }
  const ObjectShapes& shapes() const { return *shapes_; }

  /// Photons/s/m2 above the atmosphere of an object with a shape.
  double shape_photons(std::size_t object, const ObjectShape& shape, SimTime t,
                       const ObserverState& observer, double sunlit) const {
    const auto pose = shape_pose(view_, object, t, observer.position_m);
    return pose ? shape_photons_per_s_m2(*shapes_, shape, *pose, sunlit) : 0.0;
  }

  /// How many were taken.
  std::size_t samples() const { return samples_; }

 private:
  double transmission(const Vec<Gcrs>& apparent) const {
    Stopwatch timing(times_[Effect::extinction]);
    return light_.transmission(apparent);
  }
  double flicker(std::size_t object, const Vec<Gcrs>& apparent) const {
    Stopwatch timing(times_[Effect::scintillation]);
    return light_.flicker(apparent, Light::Flickering::object,
                          view_.world().roster().objects[object].catalogue_number);
  }

  const View& view_;
  const ObjectShapes* shapes_;
  EffectTimes& times_;
  mutable std::size_t samples_ = 0;
  Light light_;
  EarthShadow shadow_;
  bool with_shadow_;
  double zero_mag_;
};

/// Arcs between samples at even times, an odd number of them: each arc takes three.
std::vector<Arc> arcs_of(const std::vector<Sample>& samples, double seconds) {
  std::vector<Arc> arcs;
  const std::size_t count = (samples.size() - 1) / 2;
  const double arc_s = seconds / double(count);
  for (std::size_t k = 0; k < count; ++k) {
    const Sample &a = samples[2 * k], &m = samples[2 * k + 1], &b = samples[2 * k + 2];
    if (!a.pixel || !m.pixel || !b.pixel) continue;
    const double mean = (a.electrons_per_s + 4 * m.electrons_per_s + b.electrons_per_s) / 6;
    if (mean <= 0.0) continue;
    const double tilt = std::clamp((b.electrons_per_s - a.electrons_per_s) / (2 * mean), -1.0, 1.0);
    arcs.push_back({*a.pixel, *m.pixel, *b.pixel, mean * arc_s, tilt});
  }
  return arcs;
}

double distance_px(const Sample& a, const Sample& b) {
  return a.pixel && b.pixel
             ? std::hypot(a.pixel->x_px - b.pixel->x_px, a.pixel->y_px - b.pixel->y_px)
             : 1e9;
}

bool inside(const std::optional<PixelPosition>& p, const Optics& optics) {
  return p && p->x_px > -0.5 && p->y_px > -0.5 && p->x_px < optics.columns - 0.5 &&
         p->y_px < optics.rows - 0.5;
}

/// Turning by less than this keeps the brightness of a shape, lobes included, to a percent or two.
constexpr double still_enough_rad = 0.25 * deg;

/// Gives each arc of an object with a shape the mean of its brightness, so that a glint shorter
/// than an arc is not missed, in steps in which it turns by no more than `still_enough_rad`.
void integrate_glints(const View& view, const Painter& painter, std::size_t object,
                      const std::vector<Sample>& samples, std::vector<Arc>& arcs) {
  const auto& exposure = view.times();
  const double arc_s = exposure.seconds() / double(arcs.size());
  const double turn = turn_rad(view, object) / double(arcs.size());
  const int halves = 2 * std::clamp(int(std::ceil(turn / still_enough_rad / 2)), 1, 256);
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    const Sample& middle = samples[2 * k + 1];
    double half[2] = {};
    for (int i = 0; i < halves; ++i) {
      const SimTime t = exposure.at((double(k) + (i + 0.5) / halves) / double(arcs.size()));
      half[2 * i / halves] +=
          painter.shape_photons(object, *painter.shape(object), t, view.observer(t), middle.sunlit);
    }
    const double sum = half[0] + half[1];
    arcs[k].signal_e = sum / halves * middle.electrons_per_photon_m2 * arc_s;
    arcs[k].tilt = sum > 0.0 ? std::clamp(2 * (half[1] - half[0]) / sum, -1.0, 1.0) : 0.0;
  }
}

/// The arcs of an object with a shape: its path, then its light.
std::vector<Arc> shape_arcs(const View& view, const Painter& painter, std::size_t object,
                            const std::vector<Sample>& samples) {
  std::vector<Sample> path = samples;
  for (Sample& s : path) s.electrons_per_s = s.pixel ? 1.0 : 0.0;
  std::vector<Arc> arcs = arcs_of(path, view.times().seconds());
  if (2 * arcs.size() + 1 != samples.size())  // a part has no place in the image
    return arcs_of(samples, view.times().seconds());
  integrate_glints(view, painter, object, samples, arcs);
  return arcs;
}

/// Drawn as a point, an object with a shape may be misplaced or widened by this much.
constexpr double shape_error_px = 0.05;

/// A path this long [px] is cut into arcs; shorter ones are one parabola to 1e-3 px.
constexpr double straight_enough_px = 8.0;
constexpr std::size_t plain_arcs = 1, curved_arcs = 16, changing_arcs = 128;

/// Brightness that changes by more than this over an arc has an edge in it: shadow, horizon.
constexpr double abrupt_ratio = 0.5;

bool changes_abruptly(const std::vector<Sample>& samples) {
  double least = samples[0].electrons_per_s, most = least;
  for (const auto& s : samples) {
    least = std::min(least, s.electrons_per_s);
    most = std::max(most, s.electrons_per_s);
  }
  return least < abrupt_ratio * most;
}

bool is_resolved_at(const View& view, const Painter& painter, std::size_t object,
                    const Instant& at) {
  const ObjectShape* shape = painter.shape(object);
  const double range_m =
      norm(view.world().motion(object, at.time).position_m - at.observer.position_m);
  return shape && is_resolved(shape->radius_m, range_m,
                              view.sensor().camera.optics.pixel_angle_rad(), shape_error_px);
}

/// Snapshots of a resolved object: two for each pixel that it, or its outermost part, moves by.
std::vector<ShapeSnapshot> snapshots_of(const View& view, const Painter& painter,
                                        std::size_t object, const std::vector<Sample>& samples) {
  constexpr int most = 32;
  const auto& exposure = view.times();
  const ObjectShape& shape = *painter.shape(object);
  double path_px = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i)
    path_px += distance_px(samples[i - 1], samples[i]);
  const Instant middle(view, exposure.middle);
  const double range_m =
      norm(view.world().motion(object, exposure.middle).position_m - middle.observer.position_m);
  const double radius_px = shape.radius_m / range_m / view.sensor().camera.optics.pixel_angle_rad();
  const double swept_px = path_px + radius_px * turn_rad(view, object);
  const int count = std::clamp(int(std::ceil(2 * std::min(swept_px, 1e6))), 1, most);
  std::vector<ShapeSnapshot> snapshots;
  for (int i = 0; i < count; ++i) {
    const Instant at(view, exposure.at((i + 0.5) / count));
    const auto pose = shape_pose(view, object, at.time, at.observer.position_m);
    if (!pose) continue;
    const Motion motion = view.world().motion(object, at.time);
    const auto place = at.places.satellite(motion.position_m, motion.slope_m_per_s);
    const Sample sample = painter.sample(object, at);
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

std::vector<Truth> paint(const View& view, const Painter& painter,
                         const std::vector<std::size_t>& objects, OpticsStage& stage,
                         RateImage& image, EffectTimes& times) {
  const auto& exposure = view.times();
  const auto& optics = view.sensor().camera.optics;
  // Instants of the finest division; coarser ones take every so manieth.
  std::vector<std::optional<Instant>> instants(2 * changing_arcs + 1);
  const auto instant = [&](std::size_t k) -> const Instant& {
    if (!instants[k])
      instants[k].emplace(view, exposure.at(double(k) / double(instants.size() - 1)));
    return *instants[k];
  };
  const auto samples_of = [&](std::size_t object, std::size_t arcs) {
    std::vector<Sample> samples;
    const std::size_t step = changing_arcs / arcs;
    for (std::size_t k = 0; k < instants.size(); k += step)
      samples.push_back(painter.sample(object, instant(k)));
    return samples;
  };

  std::vector<Truth> truths;
  for (const std::size_t object : objects) {
    std::vector<Sample> samples = samples_of(object, plain_arcs);
    const Sample start = samples[0], middle = samples[1], end = samples[2];
    if (distance_px(start, middle) + distance_px(middle, end) > straight_enough_px)
      samples = samples_of(object, curved_arcs);
    if (changes_abruptly(samples)) samples = samples_of(object, changing_arcs);
    Deposited light;
    const bool resolved = is_resolved_at(view, painter, object, instant(changing_arcs));
    const bool shaped = painter.shape(object) != nullptr;
    if (shaped && turn_rad(view, object) > still_enough_rad)
      samples = samples_of(object, changing_arcs);
    auto arcs = resolved ? std::vector<Arc>{}
                : shaped ? shape_arcs(view, painter, object, samples)
                         : arcs_of(samples, exposure.seconds());
    if (const int count = view.sensor().effects.snapshots()) arcs = as_snapshots(arcs, count);
    if (resolved)
      light = draw_shape(painter.shapes(), snapshots_of(view, painter, object, samples), optics,
                         stage, image);
    if (!arcs.empty()) {
      Stopwatch timing(times[Effect::psf]);
      for (const auto& part : stage.add(arcs, image)) light = light + part;
    }
    bool enters = false;
    for (const auto& s : samples) enters = enters || inside(s.pixel, optics);
    if (light.signal_e <= 0.0 && !enters) continue;

    const Instant& mid = instant(changing_arcs);
    const auto& facts = view.world().roster().objects[object];
    const Motion motion = view.world().motion(object, mid.time);
    const auto place = mid.places.satellite(motion.position_m, motion.slope_m_per_s);
    const auto [ra, dec] = to_spherical(place.astrometric);
    const auto [apparent_ra, apparent_dec] = to_spherical(place.aberrated);
    double sunlit = 0.0;
    for (const auto& s : samples) sunlit += s.sunlit / double(samples.size());
    Truth truth{.sensor = view.sensor().name,
                .frame = exposure.frame,
                .catalogue_number = facts.catalogue_number,
                .name = facts.name,
                .start = exposure.start,
                .middle = exposure.middle,
                .end = exposure.end,
                .true_range_m = place.range_m,
                .true_ra_rad = ra,
                .true_dec_rad = dec,
                .apparent_ra_rad = apparent_ra,
                .apparent_dec_rad = apparent_dec,
                .phase_angle_rad = painter.illumination(motion, mid.observer.position_m).phase_rad,
                .sunlit = sunlit,
                .true_magnitude = painter.magnitude(object, motion, mid),
                .rendered_signal_e = light.signal_e,
                .rendered_x_px = light.x_px,
                .rendered_y_px = light.y_px,
                .in_frame = light.signal_e > 0.0,
                .whole = inside(start.pixel, optics) && inside(middle.pixel, optics) &&
                         inside(end.pixel, optics),
                .resolved = resolved};
    if (view.on_ground())
      truth.true_elevation_rad = std::asin(std::clamp(
          dot(view.up(mid.time), unit(motion.position_m - mid.observer.position_m)), -1.0, 1.0));
    const auto put = [](const Sample& s, double& x, double& y) {
      if (s.pixel) {
        x = s.pixel->x_px;
        y = s.pixel->y_px;
      }
    };
    put(start, truth.start_x_px, truth.start_y_px);
    put(middle, truth.middle_x_px, truth.middle_y_px);
    put(end, truth.end_x_px, truth.end_y_px);
    truths.push_back(std::move(truth));
  }
  return truths;
}

}  // namespace

std::vector<Truth> draw_objects(const View& view, const std::vector<std::size_t>& objects,
                                const ObjectShapes* shapes, OpticsStage& optics, RateImage& image,
                                EffectTimes& times) {
  EffectTimes inside;
  double total_s = 0.0;
  std::vector<Truth> truths;
  const Painter painter(view, shapes, inside);
  {
    Stopwatch timing(total_s);
    truths = paint(view, painter, objects, optics, image, inside);
  }
  add_object_place_costs(view, objects, painter.samples(), inside);
  for (std::size_t i = 0; i < effect_count; ++i) {
    times.seconds[i] += inside.seconds[i];
    total_s -= inside.seconds[i];
  }
  times[Effect::objects] += std::max(0.0, total_s);
  return truths;
}

}  // namespace dmise
