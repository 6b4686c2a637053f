#pragma once
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/base/files/read_progress.h"
#include "core/base/sim_time.h"

namespace dmise {

/// A JSON object of a file; its errors are `ConfigError` "FILE:LINE: KEY: reason".
class JsonRecord {
 public:
  /// `place`: "FILE:LINE".
  JsonRecord(const std::string& text, std::string place);

  bool has(const char* key) const;  // and it is not null
  /// A number, flag or text; whole numbers must be in the range of T.
  template <class T>
  T get(const char* key) const;
  double number(const char* key) const { return get<double>(key); }
  /// The value of a key that may be missing or null.
  template <class T>
  T get_or(const char* key, const T& otherwise) const {
    return has(key) ? get<T>(key) : otherwise;
  }
  SimTime time(const char* key) const { return {get<std::int64_t>(key)}; }
  template <std::size_t N>
  std::array<double, N> numbers(const char* key) const {
    const std::vector<double> list = numbers_of(key, N);
    std::array<double, N> numbers;
    std::ranges::copy(list, numbers.begin());
    return numbers;
  }
  JsonRecord object(const char* key) const;
  std::vector<JsonRecord> objects(const char* key) const;
  std::vector<std::string> texts(const char* key) const;
  std::vector<double> number_list(const char* key) const;
  /// The members of an object of numbers, or of objects, by name.
  std::map<std::string, double> all_numbers() const;
  std::vector<std::pair<std::string, JsonRecord>> all_objects() const;
  /// Number of items of a list.
  std::size_t length(const char* key) const;
  [[noreturn]] void fail(const std::string& key, const std::string& reason) const;
  /// Fails with what a name may be, and which of them is meant.
  [[noreturn]] void fail_as_none_of(const std::vector<std::string>& names, const std::string& key,
                                    const std::string& got) const;

 private:
  JsonRecord(std::shared_ptr<const nlohmann::json> object, std::string place);
  /// Makes a record of `value`, which is in this one; its messages name `key` as well.
  JsonRecord part(const nlohmann::json& value, const std::string& key) const;
  const nlohmann::json& at(const char* key) const;
  std::vector<double> numbers_of(const char* key, std::size_t count) const;
  void require(bool good, const char* key, const std::string& what) const;
  std::shared_ptr<const nlohmann::json> object_;
  std::string place_;
};

/// Calls `take(line, "FILE:LINE")` with each whole line of a file; a last line without its end was
/// interrupted and is left out. Throws `Error` for a file that can't be read.
void for_line_texts(const std::string& path, const ReadProgress& progress,
                    const std::function<void(const std::string&, const std::string&)>& take);

/// Calls `take` with each whole line of a file of JSON lines. Throws `ConfigError`
/// "FILE:LINE: KEY: reason"; a last line without its end was interrupted and is left out.
void for_lines(const std::string& path, const ReadProgress& progress,
               const std::function<void(const JsonRecord&)>& take);

}  // namespace dmise
