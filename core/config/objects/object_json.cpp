#include "core/base/files/json.h"
#include "core/config/objects/object_config.h"

namespace dmise {
namespace {

template <class F>
void write(JsonWriter& json, const char* key, const Vec<F>& v) {
  json.list(key, {v.x, v.y, v.z});
}

template <class To, class From>
void write(JsonWriter& json, const char* key, const Rotation<To, From>& r) {
  json.key(key).begin_array();
  for (const auto& row : r.m)
    for (const double x : row) json.value(x);
  json.end_array();
}

struct MotionWriter {
  JsonWriter& json;
  void operator()(const ConstantPosition<Itrs>& m) const { write(json, "itrs_m", m.position_m); }
  void operator()(const ConstantPosition<Gcrs>& m) const { write(json, "gcrs_m", m.position_m); }
  void operator()(const TwoBodyMotion& m) const {
    json.key("two_body").begin_object();
    json.field("epoch_tai_jd1", m.epoch.jd1).field("epoch_tai_jd2", m.epoch.jd2);
    write(json, "position_m", m.state.position_m);
    write(json, "velocity_m_per_s", m.state.velocity_m_per_s);
    json.field("gm_m3_per_s2", m.gm_m3_per_s2).end_object();
  }
  void operator()(const StraightMotion<Itrs>& m) const {  // from the start of the run
    write(json, "itrs_m", m.state.position_m);
    write(json, "itrs_m_per_s", m.state.velocity_m_per_s);
  }
  void operator()(const Trajectory&) const { json.field("oem", true); }  // the file has a digest
  void operator()(const NodeMotion& m) const { json.field("motion_node", m.node); }
  void operator()(const MotionModel& m) const { std::visit(*this, m); }
  void operator()(const MeanElements& e) const {
    json.list("sgp4", {e.epoch_jd1, e.epoch_jd2, e.mean_motion_rad_per_min, e.eccentricity,
                       e.inclination_rad, e.raan_rad, e.argument_of_perigee_rad, e.mean_anomaly_rad,
                       e.bstar_per_earth_radius});
  }
};

struct AttitudeWriter {
  JsonWriter& json;
  void operator()(const NadirAttitude&) const { json.field("attitude", "nadir"); }
  void operator()(const SunYawAttitude&) const { json.field("attitude", "sun_tracking"); }
  void operator()(const InertialAttitude& a) const {
    json.key("attitude").begin_object();
    write(json, "gcrs_from_body", a.gcrs_from_body);
    json.end_object();
  }
  void operator()(const SpinningAttitude& a) const {
    json.key("attitude").begin_object();
    write(json, "gcrs_from_body", a.gcrs_from_body);
    write(json, "axis", a.axis);
    json.field("rate_rad_per_s", a.rate_rad_per_s).end_object();
  }
  void operator()(const TumblingAttitude& a) const {
    json.key("attitude").begin_object();
    write(json, "gcrs_from_body", a.gcrs_from_body);
    write(json, "inertia_kg_m2", a.rotation.inertia_kg_m2());
    write(json, "rate_rad_per_s", a.rotation.rate_rad_per_s(0.0));
    json.end_object();
  }
  void operator()(const TableAttitude&) const { json.field("attitude", "table"); }
  void operator()(const NodeAttitude& a) const { json.field("attitude_node", a.node); }
};

void write_panel(JsonWriter& json, const HingedPanel& panel, bool with_geometry) {
  write(json, "panel_hinge", panel.axes.hinge);
  write(json, "panel_normal", panel.axes.normal);
  if (with_geometry) write(json, "panel_hinge_m", panel.hinge_m);
}

void write_glints(JsonWriter& json, const Glints& g) {
  json.list("glints", {g.narrowest_rad, g.widest_rad, g.parts_in_view, g.share_of_narrowest,
                       g.share_of_widest});
  if (!g.edges) return;
  write(json, "edge_axis", g.edges->axis);
  json.list("edges", {g.edges->half_width_rad, g.edges->share});
}

void write_models(JsonWriter& json, const ObjectModels& models) {
  json.key("models").begin_array();
  for (const auto& [pattern, model] : models.rules()) {
    json.begin_object().field("pattern", pattern).field("geometry", model->geometry.digest);
    std::visit(AttitudeWriter{json}, model->attitude.model);
    if (model->panel) write_panel(json, *model->panel, true);
    if (model->glints) write_glints(json, *model->glints);
    json.end_object();
  }
  json.end_array();
}

void write_walker(JsonWriter& json, const Walker& w) {
  json.field("walker", w.name).field("first_number", w.first_number);
  json.field("planes", w.planes).field("per_plane", w.per_plane).field("phasing", w.phasing);
  json.list("orbit", {w.semi_major_axis_m, w.inclination_rad, w.raan_spread_rad, w.raan_rad,
                      w.argument_of_latitude_rad, w.epoch.jd1, w.epoch.jd2, w.spacing_s});
}

void write_breakup(JsonWriter& json, const Breakup& b) {
  json.field("breakup", b.name).field("first_number", b.first_number);
  json.field("collision", b.event.kind == BreakupKind::collision);
  json.field("spacecraft", b.event.structure == BrokenStructure::spacecraft);
  json.list("event", {b.event.mass_kg, b.event.scale, b.event.projectile_mass_kg,
                      b.event.relative_speed_m_per_s, b.event.min_length_m});
  if (b.seed) json.field("seed", *b.seed);
  const auto &r = b.parent.position_m, v = b.parent.velocity_m_per_s;
  json.list("teme", {b.epoch.jd1, b.epoch.jd2, r.x, r.y, r.z, v.x, v.y, v.z});
}

void write_population(JsonWriter& json, const DebrisPopulation& p) {
  json.field("population", p.name).field("first_number", p.first_number);
  json.list("debris", {p.year, p.solar_flux_sfu, p.scale, p.min_size_m, p.max_size_m,
                       p.min_height_m, p.max_height_m, p.epoch.jd1, p.epoch.jd2});
  json.list("inclinations", p.inclinations);
  if (p.seed) json.field("seed", *p.seed);
}

void write_own(JsonWriter& json, const OwnObject& object) {
  json.begin_object().field("name", object.name);
  json.field("catalogue_number", object.catalogue_number);
  json.field("radius_m", object.sphere.radius_m).field("albedo", object.sphere.albedo);
  const auto& flight = object.motion.flight;
  if (object.motion.proximity)
    write_proximity(json, *object.motion.proximity);
  else
    std::visit(MotionWriter{json}, flight ? flight->stated : object.motion.model);
  if (flight) write_flight(json, *flight);
  if (!object.motion.satellite.empty()) json.field("satellite", object.motion.satellite);
  if (object.attitude) std::visit(AttitudeWriter{json}, object.attitude->model);
  if (object.geometry) json.field("geometry", object.geometry->digest);
  if (object.panel) write_panel(json, *object.panel, object.geometry.has_value());
  if (object.glints) write_glints(json, *object.glints);
  if (object.reentry) {
    json.list("reentry_height_m", object.reentry->height_m);
    json.list("reentry_magnitude", object.reentry->v_mag);
    json.field("reentry_range_m", object.reentry->range_m);
  }
  json.end_object();
}

}  // namespace

void write_objects(JsonWriter& json, const std::vector<ObjectSource>& catalogues,
                   const std::vector<OwnObject>& own) {
  json.key("objects").begin_array();
  for (const auto& source : catalogues) {
    json.begin_object();
    if (source.walker)
      write_walker(json, *source.walker);
    else if (source.breakup)
      write_breakup(json, *source.breakup);
    else if (source.population)
      write_population(json, *source.population);
    else
      json.field("catalogue", source.named);
    json.field("radius_m", source.sphere.radius_m).field("albedo", source.sphere.albedo);
    json.list("only", source.only);
    if (!source.models.empty()) write_models(json, source.models);
    json.end_object();
  }
  for (const auto& object : own) write_own(json, object);
  json.end_array();
}

std::vector<std::string> files_of(const std::vector<ObjectSource>& catalogues,
                                  const std::vector<OwnObject>& own) {
  std::vector<std::string> files;
  for (const auto& source : catalogues) {
    files.push_back(source.path);
    files.push_back(source.facts_path);
    for (const auto& [pattern, model] : source.models.rules())
      files.insert(files.end(),
                   {model->path, model->geometry.obj_path, model->geometry.materials_path});
  }
  for (const auto& object : own) {
    files.push_back(object.motion.trajectory_path);
    files.push_back(object.attitude ? object.attitude->table_path : "");
    files.push_back(object.geometry ? object.geometry->obj_path : "");
    files.push_back(object.geometry ? object.geometry->materials_path : "");
    if (!object.model_path.empty()) files.push_back(object.model_path);
  }
  return files;
}

}  // namespace dmise
