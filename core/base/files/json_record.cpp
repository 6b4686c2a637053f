#include "core/base/files/json_record.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/base/nearest_name.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

/// Whether powers of a number are finite.
bool is_finite(const nlohmann::json& value) { return std::abs(value.get<double>()) <= 1e30; }

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
