#include "sensors/positions/position_row.h"

#include <charconv>

#include "core/base/files/json.h"
#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr std::string_view json_start = "{\"tick\":";

template <class F>
std::string csv_vector(const std::optional<Vec<F>>& v) {
  if (!v) return ",,,";
  return "," + shortest_text(v->x / km) + "," + shortest_text(v->y / km) + "," +
         shortest_text(v->z / km);
}

std::string csv_quaternion(const std::optional<Quaternion>& q) {
  if (!q) return ",,,,";
  return "," + shortest_text(q->w) + "," + shortest_text(q->x) + "," + shortest_text(q->y) + "," +
         shortest_text(q->z);
}

template <class F>
void json_vector(JsonWriter& json, const char* key, const Vec<F>& v) {
  json.key(key).begin_array().value(v.x / km).value(v.y / km).value(v.z / km).end_array();
}

void json_quaternion(JsonWriter& json, const char* key, const Quaternion& q) {
  json.key(key).begin_array().value(q.w).value(q.x).value(q.y).value(q.z).end_array();
}

}  // namespace

std::string csv_header(bool enu) {
  if (enu)
    return "tick,time_utc,kind,name,catalogue_number,east_km,north_km,up_km,veast_km_per_s,"
           "vnorth_km_per_s,vup_km_per_s,qw,qx,qy,qz\n";
  return "tick,time_utc,kind,name,catalogue_number,x_km,y_km,z_km,vx_km_per_s,vy_km_per_s,"
         "vz_km_per_s,qw,qx,qy,qz\n";
}

std::string csv_line(const PositionRow& row) {
  std::string line = std::to_string(row.tick) + "," + row.time_utc + "," + row.kind + "," +
                     csv_field(formula_free(row.name)) + ",";
  if (row.catalogue_number > 0) line += std::to_string(row.catalogue_number);
  if (const auto& enu = row.enu)
    line += csv_vector(std::optional(enu->position_m)) + csv_vector(enu->velocity_m_per_s) +
            csv_quaternion(enu->enu_from_axes);
  else
    line += csv_vector(std::optional(row.position_m)) + csv_vector(row.slope_m_per_s) +
            csv_quaternion(row.gcrs_from_axes);
  return line + "\n";
}

std::string json_line(const PositionRow& row) {
  JsonWriter json;
  json.begin_object().field("tick", row.tick).field("time_utc", row.time_utc);
  json.field("kind", row.kind).field("name", row.name);
  if (row.catalogue_number > 0) json.field("catalogue_number", row.catalogue_number);
  if (const auto& enu = row.enu) {
    json_vector(json, "position_enu_km", enu->position_m);
    if (enu->velocity_m_per_s) json_vector(json, "velocity_enu_km_per_s", *enu->velocity_m_per_s);
    if (enu->enu_from_axes) json_quaternion(json, "quaternion_enu", *enu->enu_from_axes);
    return json.end_object().take() + "\n";
  }
  json_vector(json, "position_km", row.position_m);
  if (row.slope_m_per_s) json_vector(json, "velocity_km_per_s", *row.slope_m_per_s);
  if (row.gcrs_from_axes) json_quaternion(json, "quaternion", *row.gcrs_from_axes);
  return json.end_object().take() + "\n";
}

std::optional<Tick> tick_of_line(const std::string& line) {
  const char* begin = line.data();
  if (line.starts_with(json_start)) begin += json_start.size();
  Tick tick = 0;
  const auto read = std::from_chars(begin, line.data() + line.size(), tick);
  if (read.ec != std::errc{} || read.ptr == line.data() + line.size() || *read.ptr != ',')
    return std::nullopt;
  return tick;
}

}  // namespace dmise
