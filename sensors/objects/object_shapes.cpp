#include "sensors/objects/object_shapes.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/facets/earthshine.h"
#include "core/facets/moonlight.h"
#include "core/frames/rotation_angle.h"
#include "core/photometry/diffuse_sphere.h"
#include "core/photometry/magnitude.h"
#include "core/sky/bodies/moon_disc.h"
#include "sensors/render/render_module.h"

namespace dmise {

ObjectShape shape_of(const GeometryConfig& geometry, const std::optional<HingedPanel>& panel,
                     const Band& band, bool emits) {
  const Mesh& mesh = *geometry.mesh;
  const double radius_m = panel ? dmise::radius_m(mesh, *panel) : dmise::radius_m(mesh);
  return {std::make_shared<const FacetLight>(mesh, band, emits), panel, radius_m,
          std::min(surface_m2(mesh), pi * radius_m * radius_m)};
}

void tell_shapes(SceneFacts& scene, const ObjectShapes* shapes) {
  scene.shapes = shapes && !shapes->empty();
  scene.glints = scene.shapes && shapes->have_glints();
}

ObjectShapes::ObjectShapes(const std::vector<OwnObject>& objects, const Band& band,
                           const EffectSet& effects, const ObjectModels& models)
    : models_(models), sun_photons_(object_photons_per_s_m2(sun_v_mag, band)) {
  const bool emits = acts<ThermalEmission>(effects, {});
  const auto shape = [&](const GeometryConfig& geometry, const auto& panel, const auto& glints) {
    ObjectShape made = shape_of(geometry, panel, band, emits);
    if (glints && effects.has(Glints::facts)) made.glints = std::make_shared<GlintField>(*glints);
    return made;
  };
  for (const auto& object : objects) {
    own_.insert(object.catalogue_number);
    if (object.reentry) reentries_.emplace(object.catalogue_number, *object.reentry);
    if (object.geometry)
      shapes_.emplace(object.catalogue_number,
                      shape(*object.geometry, object.panel, object.glints));
  }
  for (const auto& [pattern, model] : models_.rules())
    if (!of_models_.contains(model.get()))
      of_models_.emplace(model.get(), shape(model->geometry, model->panel, model->glints));
}

bool ObjectShapes::have_glints() const {
  const auto glints = [](const auto& entry) { return entry.second.glints != nullptr; };
  return std::ranges::any_of(shapes_, glints) || std::ranges::any_of(of_models_, glints);
}

std::shared_ptr<const FacetLight> ObjectShape::light(const Vec<Body>& to_sun) const {
  return panel ? std::make_shared<const FacetLight>(at_rest->turned(*panel, to_sun)) : at_rest;
}

const ObjectShape* ObjectShapes::of(const ObjectInfo& object) const {
  if (of_models_.empty() || own_.contains(object.catalogue_number))
    return of(object.catalogue_number);
  const ObjectModel* model = models_.of(object.name, object.catalogue_number);
  return model ? &of_models_.at(model) : nullptr;
}

const ObjectShape* ObjectShapes::of(std::uint32_t catalogue_number) const {
  const auto found = shapes_.find(catalogue_number);
  return found == shapes_.end() ? nullptr : &found->second;
}

const ReentryLight* ObjectShapes::reentry_of(std::uint32_t catalogue_number) const {
  const auto found = reentries_.find(catalogue_number);
  return found == reentries_.end() ? nullptr : &found->second;
}

Renderer& ObjectShapes::renderer() const {
  if (!renderer_) renderer_ = load_renderer();
  return *renderer_;
}

std::string ObjectShapes::renderer_description() const {
  return renderer_ ? renderer_->description() : "";
}

std::optional<ShapePose> shape_pose(const View& view, std::size_t object, SimTime t,
                                    const Vec<Gcrs>& observer_m, int rings) {
  const auto attitude = view.states().gcrs_from_body(object, t);
  if (!attitude) return std::nullopt;
  const Vec<Gcrs> position_m = view.states().motion(object, t).position_m;
  const Vec<Gcrs> to_sun = view.environment().sun_m - position_m;
  const Vec<Gcrs> to_viewer = observer_m - position_m;
  const auto body_from_gcrs = attitude->inverse();
  const ObjectInfo& info = view.states().roster().objects[object];
  ShapePose pose{.gcrs_from_body = *attitude,
                 .to_sun = unit(body_from_gcrs * to_sun),
                 .to_viewer = unit(body_from_gcrs * to_viewer),
                 .range_m = norm(to_viewer),
                 .sun_distance_au = norm(to_sun) / au_m,
                 .secondary = {},
                 .glints = glint_key(view.seed(), info.name, info.catalogue_number)};
  if (rings > 0 && has_secondary_light(view))
    pose.secondary = secondary_light_on(view, position_m, body_from_gcrs, rings);
  return pose;
}

bool has_secondary_light(const View& view) {
  const EffectSet& effects = view.sensor().effects;
  return effects.has(Earthshine::facts) || effects.has(Moonlight::facts);
}

std::vector<LightSource> secondary_light_on(const View& view, const Vec<Gcrs>& position_m,
                                            const Rotation<Body, Gcrs>& body_from_gcrs, int rings) {
  const EffectSet& effects = view.sensor().effects;
  const Vec<Gcrs> to_sun = view.environment().sun_m - position_m;
  std::vector<LightSource> sources;
  if (effects.has(Earthshine::facts))
    sources = earthshine_sources({.albedo = view.sensor().earth_albedo, .rings = rings},
                                 body_from_gcrs * -position_m, unit(body_from_gcrs * to_sun));
  const Vec<Gcrs>& moon_m = view.environment().moon_m;
  if (effects.has(Moonlight::facts) && FreeSight(position_m, view.surface()).clear(moon_m)) {
    const double share =
        moonlight_over_sunlight(moon_m - position_m, to_sun) * view.moonlight_colour();
    if (share > 0.0) sources.push_back({unit(body_from_gcrs * (moon_m - position_m)), share});
  }
  return sources;
}

namespace {

/// Sunlight of the object, which its parts concentrate in lobes, over that of its facets, which is
/// smooth.
double over_smooth(const ObjectShape& shape, const ShapePose& pose) {
  return shape.glints ? shape.glints->over_smooth(pose.glints, pose.to_sun, pose.to_viewer) : 1.0;
}

double sunlight_m2_per_sr(const ObjectShape& shape, const FacetLight& light,
                          const ShapePose& pose) {
  const double smooth = light.reflected_m2_per_sr(pose.to_sun, pose.to_viewer);
  return smooth > 0.0 ? smooth * over_smooth(shape, pose) : smooth;
}

double secondary_photons_per_s_m2(const ObjectShapes& shapes, const FacetLight& light,
                                  const ShapePose& pose) {
  if (pose.secondary.empty()) return 0.0;
  return shapes.sun_photons() / (pose.sun_distance_au * pose.sun_distance_au) *
         light.reflected_m2_per_sr(pose.secondary, pose.to_viewer) / (pose.range_m * pose.range_m);
}

double photons_per_s_m2(const ObjectShapes& shapes, const FacetLight& light, const ShapePose& pose,
                        double sunlit, double sunlight_over_smooth) {
  double photons_per_s_sr = light.emitted_photons_per_s_sr(pose.to_viewer);
  if (sunlit > 0.0)
    photons_per_s_sr += shapes.sun_photons() * sunlit /
                        (pose.sun_distance_au * pose.sun_distance_au) * sunlight_over_smooth *
                        light.reflected_m2_per_sr(pose.to_sun, pose.to_viewer);
  return photons_per_s_sr / (pose.range_m * pose.range_m) +
         secondary_photons_per_s_m2(shapes, light, pose);
}

}  // namespace

double facet_photons_per_s_m2(const ObjectShapes& shapes, const ObjectShape& shape,
                              const ShapePose& pose, double sunlit) {
  return photons_per_s_m2(shapes, *shape.light(pose.to_sun), pose, sunlit, 1.0);
}

double shape_photons_per_s_m2(const ObjectShapes& shapes, const ObjectShape& shape,
                              const ShapePose& pose, double sunlit) {
  return photons_per_s_m2(shapes, *shape.light(pose.to_sun), pose, sunlit,
                          sunlit > 0.0 ? over_smooth(shape, pose) : 1.0);
}

double secondary_photons_per_s_m2(const ObjectShapes& shapes, const ObjectShape& shape,
                                  const ShapePose& pose) {
  return secondary_photons_per_s_m2(shapes, *shape.light(pose.to_sun), pose);
}

double shape_magnitude(const ObjectShape& shape, const ShapePose& pose) {
  const auto facets = shape.light(pose.to_sun);
  double reflected_m2_per_sr = sunlight_m2_per_sr(shape, *facets, pose);
  if (!pose.secondary.empty())
    reflected_m2_per_sr += facets->reflected_m2_per_sr(pose.secondary, pose.to_viewer);
  const double light = reflected_m2_per_sr /
                       (pose.range_m * pose.range_m * pose.sun_distance_au * pose.sun_distance_au);
  return light > 0.0 ? std::min(darkest_mag, sun_v_mag + magnitude_of_light(light)) : darkest_mag;
}

double turn_rad(const View& view, std::size_t object, double begin, double end) {
  const auto& exposure = view.times();
  const StateWindow& window = view.states();
  const double turn = window.turn_rad(object, exposure.at(begin), exposure.at(end));
  const auto& panel = window.roster().objects[object].panel;
  if (!panel || !(turn > 0.0)) return turn;
  const auto gcrs_from_panel = [&](double part) -> std::optional<Rotation<Gcrs, Panel>> {
    const SimTime t = exposure.at(part);
    const auto gcrs_from_body = window.gcrs_from_body(object, t);
    if (!gcrs_from_body) return std::nullopt;
    const Vec<Gcrs> to_sun = view.environment().sun_m - window.motion(object, t).position_m;
    return *gcrs_from_body * body_from_panel(*panel, gcrs_from_body->inverse() * to_sun);
  };
  // Steps in which the body turns little; of a fast one the first, in proportion.
  constexpr double step_rad = 0.1, max_steps = 1024;
  const double wanted = std::max(1.0, std::ceil(turn / step_rad));
  const double step = (end - begin) / wanted;
  const int steps = int(std::min(wanted, max_steps));
  double of_panel = 0.0;
  auto before = gcrs_from_panel(begin);
  for (int i = 1; i <= steps; ++i) {
    const auto after = gcrs_from_panel(double(i) == wanted ? end : begin + i * step);
    if (!before || !after) return turn;
    of_panel += rotation_angle_rad(*before * after->inverse());
    before = after;
  }
  return std::max(turn, of_panel * wanted / steps);
}

double bisector_turn_rad(const View& view, std::size_t object, double begin, double end) {
  const auto bisector = [&](double part) -> std::optional<Vec<Body>> {
    const SimTime t = view.times().at(part);
    const auto pose = shape_pose(view, object, t, view.observer(t).position_m, 0);
    return pose ? std::optional(bisector_of(pose->to_sun, pose->to_viewer)) : std::nullopt;
  };
  const auto first = bisector(begin), last = bisector(end);
  return first && last ? angle_rad(*first, *last) : 0.0;
}

}  // namespace dmise
