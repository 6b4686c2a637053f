#include "core/products/task_json.h"

#include "core/base/json.h"
#include "core/products/field_value.h"
#include "core/products/task_fields.h"

namespace dmise {

std::string to_json(const Task& t, const std::function<std::string(SimTime)>& utc) {
  JsonWriter json;
  json.begin_object();
#define DMISE_VALUE(field_, name, unit) json.field(name, in_unit(t.field_, unit));
#define DMISE_TIME(field_, name) \
  json.field(name "_ns", t.field_.ns).field(name "_utc", utc(t.field_));
#define DMISE_LIST(field_, name, ...) json.list(name, t.field_);
  DMISE_TASK_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_LIST, DMISE_LIST)
#undef DMISE_VALUE
#undef DMISE_TIME
#undef DMISE_LIST
  return json.end_object().take();
}

}  // namespace dmise
