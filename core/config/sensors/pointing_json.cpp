#include "core/base/files/json.h"
#include "core/config/sensors/pointing_config.h"

namespace dmise {
namespace {

struct PointingWriter {
  JsonWriter& json;

  void operator()(PointUp) const { json.value("zenith"); }
  void operator()(const PointHorizon& p) const {
    json.begin_object().field("azimuth_deg", p.azimuth_deg).field("elevation_deg", p.elevation_deg);
    if (turn_rate_deg_per_s(p) > 0.0)
      json.field("azimuth_rate_deg_per_s", p.azimuth_rate_deg_per_s)
          .field("elevation_rate_deg_per_s", p.elevation_rate_deg_per_s);
    json.end_object();
  }
  void operator()(const PointSky& p) const {
    json.begin_object().field("ra_deg", p.ra_deg).field("dec_deg", p.dec_deg);
    if (turn_rate_deg_per_s(p) > 0.0)
      json.field("ra_rate_deg_per_s", p.ra_rate_deg_per_s)
          .field("dec_rate_deg_per_s", p.dec_rate_deg_per_s);
    json.end_object();
  }
  void operator()(const PointTarget& p) const {
    json.begin_object().field("target", p.object);
    json.field("place", p.geometric ? "geometric" : "apparent");
    if (p.offset_x_deg != 0.0 || p.offset_y_deg != 0.0)
      json.list("offset_deg", {p.offset_x_deg, p.offset_y_deg});
    json.end_object();
  }
  void operator()(const PointBody& p) const {
    json.begin_object().key("body_from_camera").begin_array();
    for (const auto& row : p.body_from_camera.m)
      for (const double x : row) json.value(x);
    json.end_array().end_object();
  }
  void operator()(const PointEnu& p) const {  // the origin is the scenario's
    const auto vector = [&](const char* key, const Vec<Enu>& v) {
      json.list(key, {v.x, v.y, v.z});
    };
    json.begin_object().key("enu").begin_object();
    p.at_m ? vector("look_at_m", *p.at_m) : vector("look", p.look);
    vector("up", p.up);
    json.end_object().end_object();
  }
  void operator()(const PointScan& p) const {
    json.begin_object().key("scan");
    std::visit(*this, p.start);
    json.list("axis", p.axis).field("rate_deg_per_s", p.rate_deg_per_s).end_object();
  }
  void operator()(const PointCued& p) const {
    const CueSettings& c = p.cue;
    json.begin_object().key("cued").begin_object().key("park");
    (*this)(p.park);
    json.field("slew_deg_per_s", c.slew_deg_per_s).field("slew_deg_per_s2", c.slew_deg_per_s2);
    if (c.mount == MountKind::altazimuth) {
      json.field("mount", "altazimuth").field("azimuth_deg_per_s", c.azimuth_deg_per_s);
      json.field("azimuth_deg_per_s2", c.azimuth_deg_per_s2);
      json.list("azimuth_range_deg", c.azimuth_range_deg);
    }
    if (c.greatest_elevation_deg < 90)
      json.field("greatest_elevation_deg", c.greatest_elevation_deg);
    json.field("settle_s", c.settle_s).field("least_elevation_deg", c.min_elevation_deg);
    json.field("sun_exclusion_deg", c.sun_exclusion_deg);
    json.field("moon_exclusion_deg", c.moon_exclusion_deg).field("exposures", c.exposures);
    json.field("sigma_arcsec", c.sigma_arcsec).field("limiting_magnitude", c.limiting_magnitude);
    json.field("least_gain_nats", c.min_gain_nats).end_object().end_object();
  }
};

}  // namespace

void write_pointing(JsonWriter& json, const Pointing& pointing) {
  std::visit(PointingWriter{json}, pointing);
}

}  // namespace dmise
