#include "core/score/json_record.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/printable.h"
#include "core/base/text_file.h"
#include "core/base/units.h"
#include "core/detection/detection_json.h"
#include "core/products/detection_fields.h"
#include "core/products/track_fields.h"

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
const char* name_of(MagnitudeSystem system) { return magnitude_system_name(system); }
const char* name_of(TrackStatus status) { return track_status_name(status); }

/// The value with that name of an enumeration of three.
template <class Enum>
Enum named(const JsonRecord& record, const char* key) {
  const std::string name = record.get<std::string>(key);
  int value = 0;
  while (value < 3 && name != name_of(Enum(value))) ++value;
  if (value == 3) {
    std::vector<std::string> names;
    for (int k = 0; k < 3; ++k)  // one of two names what is none as the first
      if (std::ranges::find(names, name_of(Enum(k))) == names.end())
        names.emplace_back(name_of(Enum(k)));
    record.fail_as_none_of(names, key, name);
  }
  return Enum(value);
}

/// Whether powers of a number are finite.
bool is_finite(const nlohmann::json& value) { return std::abs(value.get<double>()) <= 1e30; }

Vec<Gcrs> vector_of(const JsonRecord& record, const char* key) {
  const auto v = record.numbers<3>(key);
  return {v[0], v[1], v[2]};
}

}  // namespace

JsonRecord::JsonRecord(const std::string& text, std::string place)
    : JsonRecord(
          std::make_shared<const nlohmann::json>(nlohmann::json::parse(text, nullptr, false)),
          std::move(place)) {}

JsonRecord::JsonRecord(std::shared_ptr<const nlohmann::json> object, std::string place)
    : object_(std::move(object)), place_(std::move(place)) {
  if (!object_->is_object()) throw ConfigError(place_ + ": must be a JSON object");
}

JsonRecord JsonRecord::part(const nlohmann::json& value, const std::string& key) const {
  return {{object_, &value}, place_ + ": " + key};
}

template <class T>
T JsonRecord::get(const char* key) const {
  const nlohmann::json& value = at(key);
  if constexpr (std::same_as<T, bool>) {
    require(value.is_boolean(), key, "true or false");
  } else if constexpr (std::integral<T>) {
    require(value.is_number_integer() && value == nlohmann::json(value.get<T>()), key,
            "a whole number in range");
  } else if constexpr (std::floating_point<T>) {
    require(value.is_number(), key, "a number");
    require(is_finite(value), key, "at most 1e30");
  } else {
    require(value.is_string(), key, "a text");
  }
  return value.get<T>();
}
template bool JsonRecord::get(const char*) const;
template int JsonRecord::get(const char*) const;
template std::uint32_t JsonRecord::get(const char*) const;
template std::int64_t JsonRecord::get(const char*) const;
template std::uint64_t JsonRecord::get(const char*) const;
template double JsonRecord::get(const char*) const;
template std::string JsonRecord::get(const char*) const;

std::vector<double> JsonRecord::numbers_of(const char* key, std::size_t count) const {
  const nlohmann::json& list = at(key);
  bool good = list.is_array() && list.size() == count, finite = true;
  for (std::size_t i = 0; good && i < count; ++i) {
    good = list[i].is_number();
    finite = finite && good && is_finite(list[i]);
  }
  require(good, key, std::to_string(count) + " numbers");
  require(finite, key, "at most 1e30");
  return list.get<std::vector<double>>();
}

void JsonRecord::fail(const std::string& key, const std::string& reason) const {
  throw ConfigError(place_ + ": " + key + ": " + reason);
}

void JsonRecord::fail_as_none_of(const std::vector<std::string>& names, const std::string& key,
                                 const std::string& got) const {
  fail(key,
       "must be one of " + joined(names) + did_you_mean(got, names) + ", got " + printable(got));
}

bool JsonRecord::has(const char* key) const {
  const auto found = object_->find(key);
  return found != object_->end() && !found->is_null();
}

const nlohmann::json& JsonRecord::at(const char* key) const {
  const auto found = object_->find(key);
  if (found == object_->end()) fail(key, "is missing");
  return *found;
}

void JsonRecord::require(bool good, const char* key, const std::string& what) const {
  constexpr auto as_bytes = nlohmann::json::error_handler_t::replace;
  if (!good)
    fail(key, "must be " + what + ", got " + printable(at(key).dump(-1, ' ', false, as_bytes), 80));
}

JsonRecord JsonRecord::object(const char* key) const { return part(at(key), key); }

std::vector<JsonRecord> JsonRecord::objects(const char* key) const {
  require(at(key).is_array(), key, "a list");
  std::vector<JsonRecord> out;
  for (const auto& value : at(key)) out.push_back(part(value, key));
  return out;
}

std::map<std::string, double> JsonRecord::all_numbers() const {
  std::map<std::string, double> out;
  for (const auto& [key, value] : object_->items()) {
    if (value.is_null()) continue;
    require(value.is_number() && is_finite(value), key.c_str(), "a number");
    out.emplace(key, value.get<double>());
  }
  return out;
}

std::vector<std::pair<std::string, JsonRecord>> JsonRecord::all_objects() const {
  std::vector<std::pair<std::string, JsonRecord>> out;
  for (const auto& [key, value] : object_->items()) out.emplace_back(key, part(value, key));
  return out;
}

std::vector<double> JsonRecord::number_list(const char* key) const {
  std::vector<double> numbers;
  require(at(key).is_array(), key, "a list of numbers");
  for (const nlohmann::json& value : at(key)) {
    require(value.is_number(), key, "a list of numbers");
    numbers.push_back(value.get<double>());
  }
  return numbers;
}

std::size_t JsonRecord::length(const char* key) const {
  require(at(key).is_array(), key, "a list");
  return at(key).size();
}

std::vector<std::string> JsonRecord::texts(const char* key) const {
  require(at(key).is_array(), key, "a list of texts");
  std::vector<std::string> out;
  for (const auto& value : at(key)) {
    require(value.is_string(), key, "a list of texts");
    out.push_back(value);
  }
  return out;
}

Detection detection_of(const JsonRecord& record) {
  Detection d;
#define DMISE_VALUE(field, key, unit) read(record, key, unit, d.field);
#define DMISE_TIME(field, key) d.field = record.time(key "_ns");
#define DMISE_NAME(field, key, Enum) d.field = named<Enum>(record, key);
#define DMISE_LIST(field_, key, unit)                                    \
  d.field_ = record.numbers<std::tuple_size_v<decltype(d.field_)>>(key); \
  for (double& value : d.field_) value *= (unit);
#define DMISE_VECTOR(field, key) d.field = vector_of(record, key);
#define DMISE_PAIR(first, second, key)     \
  {                                        \
    const auto v = record.numbers<2>(key); \
    d.first = v[0];                        \
    d.second = v[1];                       \
  }
#define DMISE_TEXT(key, value)
#define DMISE_WHERE(field, key) d.field = record.has(key) && record.get<bool>(key);
#define DMISE_MEASURED(field, key) \
  if (record.has(key)) d.field = record.number(key);
  DMISE_DETECTION_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_NAME, DMISE_LIST, DMISE_VECTOR, DMISE_PAIR,
                         DMISE_TEXT, DMISE_WHERE, DMISE_MEASURED)
#undef DMISE_VALUE
#undef DMISE_TIME
#undef DMISE_NAME
#undef DMISE_LIST
#undef DMISE_VECTOR
#undef DMISE_MEASURED
  if (d.range_m.has_value() != d.range_sigma_m.has_value())
    record.fail("range_m", "goes with range_sigma_m");
  if (d.range_rate_m_per_s.has_value() != d.range_rate_sigma_m_per_s.has_value())
    record.fail("range_rate_m_per_s", "goes with range_rate_sigma_m_per_s");
  return d;
}

Truth truth_of(const JsonRecord& record) {
  Truth t;
  t.sensor = record.get<std::string>("sensor");
  t.frame = record.get<std::uint32_t>("frame");
  t.catalogue_number = record.get<std::uint32_t>("catalogue_number");
  t.name = record.get<std::string>("name");
  t.start = record.time("start_ns");
  t.middle = record.time("middle_ns");
  t.end = record.time("end_ns");
  if (record.has("true_position_gcrs_m"))
    t.true_position_m = vector_of(record, "true_position_gcrs_m");
  if (record.has("true_velocity_gcrs_m_per_s"))
    t.true_velocity_m_per_s = vector_of(record, "true_velocity_gcrs_m_per_s");
  t.true_range_m = record.number("true_range_m");
  t.true_ra_rad = record.number("true_ra_deg") * deg;
  t.true_dec_rad = record.number("true_dec_deg") * deg;
  t.apparent_ra_rad = record.number("apparent_ra_deg") * deg;
  t.apparent_dec_rad = record.number("apparent_dec_deg") * deg;
  t.true_elevation_rad = record.number("true_elevation_deg") * deg;
  t.phase_angle_rad = record.number("phase_angle_deg") * deg;
  t.sunlit = record.number("sunlit");
  t.true_magnitude = record.number("true_magnitude");
  t.rendered_signal_e = record.number("rendered_signal_e");
  const auto place = [&](const char* key, double& x, double& y) {
    const auto v = record.numbers<2>(key);
    x = v[0];
    y = v[1];
  };
  if (record.has("rendered_px")) place("rendered_px", t.rendered_x_px, t.rendered_y_px);
  place("start_px", t.start_x_px, t.start_y_px);
  place("middle_px", t.middle_x_px, t.middle_y_px);
  place("end_px", t.end_x_px, t.end_y_px);
  t.in_frame = record.get<bool>("in_frame");
  t.whole = record.get<bool>("whole");
  t.resolved = record.get<bool>("resolved");
  if (record.has("camera_from_gcrs")) {
    const auto q = record.numbers<4>("camera_from_gcrs");
    t.camera_from_gcrs = Quaternion{q[0], q[1], q[2], q[3]};
  }
  return t;
}

Track track_of(const JsonRecord& record) {
  Track t;
#define DMISE_VALUE(field, key) t.field = record.get<decltype(t.field)>(key);
#define DMISE_TIME(field, key) t.field = record.time(key "_ns");
#define DMISE_NAME(field, key, Enum) t.field = named<Enum>(record, key);
#define DMISE_LIST(field, key, size) t.field = record.numbers<size>(key);
#define DMISE_VECTOR(field, key) t.field = vector_of(record, key);
#define DMISE_TEXTS(field, key) t.field = record.texts(key);
  DMISE_TRACK_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_NAME, DMISE_LIST, DMISE_VECTOR, DMISE_TEXTS)
#undef DMISE_PAIR
#undef DMISE_TEXT
#undef DMISE_WHERE
#undef DMISE_VALUE
#undef DMISE_TIME
#undef DMISE_NAME
#undef DMISE_LIST
#undef DMISE_VECTOR
#undef DMISE_TEXTS
  return t;
}

void for_line_texts(const std::string& path, const ReadProgress& progress,
                    const std::function<void(const std::string&, const std::string&)>& take) {
  const std::string text = read_text_file(path, std::size_t(1) << 36);
  std::size_t begin = 0, line = 1;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    if (line % 4096 == 0) progress(double(begin) / double(text.size()), path);
    take(text.substr(begin, end - begin), path + ":" + std::to_string(line++));
  }
}

void for_lines(const std::string& path, const ReadProgress& progress,
               const std::function<void(const JsonRecord&)>& take) {
  for_line_texts(path, progress, [&](const std::string& line, const std::string& place) {
    take(JsonRecord(line, place));
  });
}

}  // namespace dmise
