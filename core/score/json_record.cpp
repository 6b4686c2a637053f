#include "core/score/json_record.h"

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/detection/detection_json.h"
#include "core/products/detection_fields.h"

namespace dmise {
namespace {

void read(const JsonRecord& record, const char* key, double unit, double& value) {
  value = record.number(key) * unit;
}
template <class T>
void read(const JsonRecord& record, const char* key, int, T& value) {
  value = record.get<T>(key);
}

const char* name_of(DetectionKind kind) { return detection_kind_name(kind); }
const char* name_of(ExposureEpoch epoch) { return exposure_epoch_name(epoch); }

}  // namespace

JsonRecord::JsonRecord(const std::string& text, std::string place)
    : JsonRecord(nlohmann::json::parse(text, nullptr, false), std::move(place)) {}

JsonRecord::JsonRecord(nlohmann::json object, std::string place)
    : object_(std::move(object)), place_(std::move(place)) {
  if (!object_.is_object()) throw ConfigError(place_ + ": must be a JSON object");
}

void JsonRecord::fail(const std::string& key, const std::string& reason) const {
  throw ConfigError(place_ + ": " + key + ": " + reason);
}

bool JsonRecord::has(const char* key) const {
  const auto found = object_.find(key);
  return found != object_.end() && !found->is_null();
}

const nlohmann::json& JsonRecord::at(const char* key) const {
  const auto found = object_.find(key);
  if (found == object_.end()) fail(key, "is missing");
  return *found;
}

void JsonRecord::require(bool good, const char* key, const std::string& what) const {
  constexpr auto as_bytes = nlohmann::json::error_handler_t::replace;
  if (!good)
    fail(key, "must be " + what + ", got " + printable(at(key).dump(-1, ' ', false, as_bytes), 80));
}

JsonRecord JsonRecord::object(const char* key) const { return {at(key), place_ + ": " + key}; }

std::vector<JsonRecord> JsonRecord::objects(const char* key) const {
  require(at(key).is_array(), key, "a list");
  std::vector<JsonRecord> out;
  for (const auto& value : at(key)) out.push_back({value, place_ + ": " + key});
  return out;
}

Detection detection_of(const JsonRecord& record) {
  Detection d;
#define DMISE_VALUE(field, key, unit) read(record, key, unit, d.field);
#define DMISE_TIME(field, key) d.field = record.time(key "_ns");
#define DMISE_NAME(field, key, Enum)                                        \
  {                                                                         \
    const std::string name = record.get<std::string>(key);                  \
    int value = 0;                                                          \
    while (value < 3 && name != name_of(Enum(value))) ++value;              \
    if (value == 3) record.fail(key, "is unknown, got " + printable(name)); \
    d.field = Enum(value);                                                  \
  }
#define DMISE_LIST(field_, key, unit)                                    \
  d.field_ = record.numbers<std::tuple_size_v<decltype(d.field_)>>(key); \
  for (double& value : d.field_) value *= (unit);
#define DMISE_VECTOR(field, key)           \
  {                                        \
    const auto v = record.numbers<3>(key); \
    d.field = {v[0], v[1], v[2]};          \
  }
#define DMISE_PAIR(first, second, key)     \
  {                                        \
    const auto v = record.numbers<2>(key); \
    d.first = v[0];                        \
    d.second = v[1];                       \
  }
#define DMISE_TEXT(key, value)
  DMISE_DETECTION_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_NAME, DMISE_LIST, DMISE_VECTOR, DMISE_PAIR,
                         DMISE_TEXT)
  return d;
}

}  // namespace dmise
