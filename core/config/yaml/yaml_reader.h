#pragma once
#include <yaml-cpp/yaml.h>

#include <initializer_list>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/nearest_name.h"
#include "core/config/yaml/section.h"
#include "core/time/julian_date.h"

namespace dmise {

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
  /// Whether it is a scalar of digits, signs and points, which are meant as a number.
  bool is_like_number() const;
  const std::string& file() const { return *file_; }
  const std::string& path() const { return path_; }
  std::string where() const;  // file:line:column
  std::string place() const;  // file:line:column: key.path

  // Without a range: that of the value's section, if it was read from one.
  double number() const;
  double number(Bounds bounds) const;
  std::int64_t integer() const;
  std::int64_t integer(std::int64_t least, std::int64_t most) const;
  std::string text() const;
  /// Path of the file that a text names, beside the value's own file or as given.
  std::string existing_file() const;
  Utc time() const;
  bool flag() const;  // on/off, true/false, yes/no
  /// One of the choices of the value's section.
  std::string choice() const;
  /// One of `choices`; an error names them.
  std::string choice(std::span<const std::string_view> choices) const;
  /// The meaning of the choice, of those of all choices of the value's section in their order.
  template <class Meaning>
  Meaning chosen(std::initializer_list<Meaning> meanings) const {
    return meanings.begin()[choice_index(meanings.size())];
  }
  /// The number of the choice among those of the value's section.
  std::size_t chosen_index() const;
  std::vector<YamlValue> list() const;
  /// A list of numbers, with ranges and, if it has one, the length of the value's section.
  std::vector<double> numbers() const;

  /// Replaces the value wherever it stands, also by aliases. Its place in the file stays.
  void become(const std::string& scalar) { node_ = scalar; }
  /// Replaces the value by another of the same file, with the place of that.
  void become(const YamlValue& other) {
    YAML::Node copy = node_;  // the one that is assigned to no longer refers to the tree
    copy = other.node_;
  }
  const YAML::Node& node() const { return node_; }

  [[noreturn]] void fail(const std::string& reason, bool show_value = true) const;
  /// Text of the error that `fail` throws: `file:line:column: key.path: reason, got value`.
  std::string complaint(const std::string& reason, bool show_value = true) const;

 private:
  friend class YamlMap;
  YamlValue(YAML::Node node, std::shared_ptr<const std::string> file, std::string path,
            const Forms* forms = nullptr)
      : node_(std::move(node)), file_(std::move(file)), path_(std::move(path)), forms_(forms) {}
  /// Returns the form of its section that a reader asks for. Throws `std::logic_error` if the
  /// section has none; null for a value of no section.
  const Form* form(Form::Kind kind) const;
  std::size_t choice_index(std::size_t count) const;

  YAML::Node node_;
  std::shared_ptr<const std::string> file_;
  std::string path_;
  const Forms* forms_ = nullptr;  // that its section allows
};

/// Reads the file that `value` names, or the preset of this name among launch/KINDs ("camera",
/// "site"). Throws `ConfigError` that names the presets, and for a distribution in one.
YamlValue load_preset(const std::string& kind, const YamlValue& value);

/// The keys of a YAML mapping. Each model reads its own; `done()` refuses keys that were not read
/// and suggests the nearest known one. A section decides keys, types, ranges and defaults: asking
/// for others throws `std::logic_error`.
class YamlMap {
 public:
  explicit YamlMap(const YamlValue& value);
  YamlMap(const YamlValue& value, const Section& section);

  std::optional<YamlValue> find(std::string_view key);
  YamlValue require(std::string_view key);
  std::vector<std::string> keys() const;
  /// Throws `ConfigError` with the reason if there is a key that users may expect but no section
  /// has.
  void refuse(std::string_view key, const std::string& reason);

  // A key that is not given has the default that its section states, if it states one.
  double number(std::string_view key) { return given_or_default(key).number(); }
  double number(std::string_view key, Bounds bounds) { return require(key).number(bounds); }
  std::int64_t integer(std::string_view key) { return given_or_default(key).integer(); }
  std::string text(std::string_view key) { return given_or_default(key).text(); }
  bool flag(std::string_view key) { return given_or_default(key).flag(); }

  const YamlValue& value() const { return value_; }
  /// Its section; it must have one.
  const Section& section() const { return *section_; }
  void done() const;

 private:
  std::string child_path(std::string_view key) const;
  std::optional<YamlValue> look_up(std::string_view key, const Forms* forms);
  YamlValue given_or_default(std::string_view key);

  YamlValue value_;
  const Section* section_ = nullptr;
  std::set<std::string, std::less<>> known_;
};

}  // namespace dmise
