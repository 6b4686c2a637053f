#pragma once
#include <yaml-cpp/yaml.h>

#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/nearest_name.h"

namespace dmise {

/// Range of a number, and the reason for it in messages.
struct Bounds {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_open = false;  // `least` itself is refused

  static Bounds positive() { return {.least = 0.0, .least_open = true}; }
  static Bounds not_negative() { return {.least = 0.0}; }
  static Bounds between(double least, double most) { return {.least = least, .most = most}; }
};

/// A value of a YAML file with its position: every error reads `file:line:column: key.path: reason,
/// got value`. Copies are the same value.
class YamlValue {
 public:
  /// Reads a whole file. Throws `ConfigError`, also for a duplicate key.
  static YamlValue load(const std::string& path);
  static YamlValue parse(const std::string& text, const std::string& file);

  bool is_map() const { return node_.IsMap(); }
  bool is_list() const { return node_.IsSequence(); }
  bool is_scalar() const { return node_.IsScalar(); }
  const std::string& file() const { return *file_; }
  const std::string& path() const { return path_; }
  std::string where() const;  // file:line:column
  std::string place() const;  // file:line:column: key.path

  double number(Bounds bounds = {}) const;
  std::int64_t integer(std::int64_t least, std::int64_t most) const;
  std::string text() const;
  bool flag() const;  // on/off, true/false, yes/no
  /// One of `choices`; an error suggests the nearest.
  std::string choice(std::span<const std::string_view> choices) const;
  std::string choice(std::initializer_list<std::string_view> choices) const {
    return choice(std::span(choices.begin(), choices.size()));
  }
  std::vector<YamlValue> list() const;
  /// A list of `count` numbers.
  std::vector<double> numbers(std::size_t count, Bounds bounds = {}) const;

  /// Replaces the value wherever it stands, also by aliases. Its place in the file stays.
  void become(const std::string& scalar) { node_ = scalar; }
  /// Replaces the value by another of the same file, with the place of that.
  void become(const YamlValue& other) { node_ = other.node_; }
  const YAML::Node& node() const { return node_; }

  [[noreturn]] void fail(const std::string& reason, bool show_value = true) const;
  /// Text of the error that `fail` throws: `file:line:column: key.path: reason, got value`.
  std::string complaint(const std::string& reason, bool show_value = true) const;

 private:
  friend class YamlMap;
  YamlValue(YAML::Node node, std::shared_ptr<const std::string> file, std::string path)
      : node_(std::move(node)), file_(std::move(file)), path_(std::move(path)) {}

  YAML::Node node_;
  std::shared_ptr<const std::string> file_;
  std::string path_;
};

/// The keys of a YAML mapping. Each model reads its own; `done()` refuses keys that were not read
/// and suggests the nearest known one.
class YamlMap {
 public:
  explicit YamlMap(const YamlValue& value);

  std::optional<YamlValue> find(std::string_view key);
  YamlValue require(std::string_view key);
  std::vector<std::string> keys() const;

  double number(std::string_view key, Bounds bounds = {}) { return require(key).number(bounds); }
  double number_or(std::string_view key, double otherwise, Bounds bounds = {});
  std::int64_t integer_or(std::string_view key, std::int64_t otherwise, std::int64_t least,
                          std::int64_t most);
  std::string text(std::string_view key) { return require(key).text(); }
  std::string text_or(std::string_view key, std::string otherwise);
  bool flag_or(std::string_view key, bool otherwise);

  const YamlValue& value() const { return value_; }
  void done() const;

 private:
  std::string child_path(std::string_view key) const;
  YamlValue value_;
  std::set<std::string, std::less<>> known_;
};

}  // namespace dmise
