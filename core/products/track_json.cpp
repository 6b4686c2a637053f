#include "core/products/track_json.h"

#include "core/base/json.h"
#include "core/products/track_fields.h"

namespace dmise {

const char* track_status_name(TrackStatus status) {
  constexpr const char* names[] = {"tentative", "confirmed", "lost"};
  return names[std::size_t(status)];
}

std::string to_json(const Track& t, const std::function<std::string(SimTime)>& utc) {
  JsonWriter json;
  json.begin_object();
#define DMISE_VALUE(field_, name) json.field(name, t.field_);
#define DMISE_TIME(field_, name) \
  json.field(name "_ns", t.field_.ns).field(name "_utc", utc(t.field_));
#define DMISE_NAME(field_, name, Enum) json.field(name, track_status_name(t.field_));
#define DMISE_LIST(field_, name, ...) json.list(name, t.field_);
#define DMISE_VECTOR(field_, name) json.list(name, {t.field_.x, t.field_.y, t.field_.z});
  DMISE_TRACK_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_NAME, DMISE_LIST, DMISE_VECTOR, DMISE_LIST)
#undef DMISE_VALUE
#undef DMISE_TIME
#undef DMISE_NAME
#undef DMISE_LIST
#undef DMISE_VECTOR
  return json.end_object().take();
}

}  // namespace dmise
