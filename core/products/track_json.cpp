#include "core/products/track_json.h"

#include "core/base/json.h"
#include "core/products/track_fields.h"

namespace dmise {

const char* track_status_name(TrackStatus status) {
  switch (status) {
    case TrackStatus::tentative:
      return "tentative";
    case TrackStatus::confirmed:
      return "confirmed";
    case TrackStatus::lost:
      return "lost";
  }
  return "tentative";
}

std::string to_json(const Track& t, const std::function<std::string(SimTime)>& utc) {
  JsonWriter json;
  json.begin_object();
#define DMISE_VALUE(field_, name) json.field(name, t.field_);
#define DMISE_TIME(field_, name) \
  json.field(name "_ns", t.field_.ns).field(name "_utc", utc(t.field_));
#define DMISE_NAME(field_, name, Enum) json.field(name, track_status_name(t.field_));
#define DMISE_LIST(field_, name, size)                   \
  json.key(name).begin_array();                          \
  for (const double value : t.field_) json.value(value); \
  json.end_array();
#define DMISE_VECTOR(field_, name)                                                    \
  json.key(name).begin_array().value(t.field_.x).value(t.field_.y).value(t.field_.z); \
  json.end_array();
#define DMISE_TEXTS(field_, name)                            \
  json.key(name).begin_array();                              \
  for (const std::string& text : t.field_) json.value(text); \
  json.end_array();
  DMISE_TRACK_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_NAME, DMISE_LIST, DMISE_VECTOR, DMISE_TEXTS)
  return json.end_object().take();
}

}  // namespace dmise
