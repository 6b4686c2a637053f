#include "core/config/yaml_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/base/text_file.h"
#include "core/config/yaml_limits.h"

namespace dmise {
namespace {

std::string place_of(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return printable(file);
  return printable(file) + ":" + std::to_string(mark.line + 1) + ":" +
         std::to_string(mark.column + 1);
}

std::string number_text(double x) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, x).ptr};
}

/// Path of a value in its file; formatted only for messages, because keys may be long.
struct NodePath {
  const NodePath* outer = nullptr;  // null: the file itself
  std::string key;
  std::size_t index = 0;  // in a list, where there is no key

  std::string text() const {
    if (!outer) return "";
    const std::string before = outer->text();
    if (key.empty()) return before + "[" + std::to_string(index) + "]";
    return before + (before.empty() ? "" : ".") + key;
  }
};

void refuse_repeated_keys(const YAML::Node& node, const std::string& file, const NodePath& path) {
  if (node.IsMap()) {
    std::set<std::string> seen;
    for (const auto& entry : node) {
      const bool is_word = entry.first.IsScalar();
      const NodePath inner{&path, is_word ? entry.first.Scalar() : "?"};
      const auto refuse = [&](const char* why) {
        throw ConfigError(place_of(file, entry.first.Mark()) + ": " + printable(inner.text()) +
                          why);
      };
      if (!is_word) refuse(": key must be a word");
      if (!seen.insert(entry.first.Scalar()).second) refuse(": key given twice");
      refuse_repeated_keys(entry.second, file, inner);
    }
  } else if (node.IsSequence()) {
    for (std::size_t i = 0; i < node.size(); ++i)
      refuse_repeated_keys(node[i], file, {&path, "", i});
  }
}

}  // namespace

YamlValue YamlValue::load(const std::string& path) {
  return parse(read_text_file(path, YamlLimits{}.bytes), path);
}

YamlValue YamlValue::parse(const std::string& text, const std::string& file) {
  check_yaml_limits(text, file);
  try {
    auto node = YAML::Load(text);
    if (!node.IsMap())
      throw ConfigError(printable(file) + ":1:1: must be a mapping of keys to values");
    refuse_repeated_keys(node, file, {});
    return {node, std::make_shared<const std::string>(file), ""};
  } catch (const YAML::Exception& e) {
    throw ConfigError(place_of(file, e.mark) + ": not valid YAML: " + printable(e.msg));
  }
}

std::string YamlValue::where() const { return place_of(*file_, node_.Mark()); }

std::string YamlValue::place() const {
  return where() + (path_.empty() ? "" : ": " + printable(path_));
}

std::string YamlValue::complaint(const std::string& reason, bool show_value) const {
  constexpr std::size_t most_shown_bytes = 200;
  std::string text = place() + ": " + reason;
  if (show_value) {
    text += ", got ";
    if (node_.IsScalar()) {
      text += node_.Scalar().empty() ? "''" : printable(node_.Scalar(), most_shown_bytes);
    } else {
      text += node_.IsMap() ? "a mapping" : node_.IsSequence() ? "a list" : "nothing";
    }
  }
  return text;
}

void YamlValue::fail(const std::string& reason, bool show_value) const {
  throw ConfigError(complaint(reason, show_value));
}

double YamlValue::number(Bounds bounds) const {
  if (!is_scalar()) fail("must be a number");
  const std::string& s = node_.Scalar();
  double x = 0.0;
  const char* first = s.data() + (s.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(first, s.data() + s.size(), x);
  if (error != std::errc{} || end != s.data() + s.size() || !std::isfinite(x))
    fail("must be a number");
  if (bounds.least_open ? x <= bounds.least : x < bounds.least)
    fail("must be " + std::string(bounds.least_open ? "> " : ">= ") + number_text(bounds.least));
  if (x > bounds.most) fail("must be <= " + number_text(bounds.most));
  return x;
}

std::int64_t YamlValue::integer(std::int64_t least, std::int64_t most) const {
  if (!is_scalar()) fail("must be a whole number");
  const std::string& s = node_.Scalar();
  std::int64_t x = 0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
  if (error != std::errc{} || end != s.data() + s.size()) fail("must be a whole number");
  if (x < least) fail("must be >= " + std::to_string(least));
  if (x > most) fail("must be <= " + std::to_string(most));
  return x;
}

std::string YamlValue::text() const {
  if (!is_scalar() || node_.Scalar().empty()) fail("must be a text");
  return node_.Scalar();
}

bool YamlValue::flag() const {
  if (is_scalar()) {
    const std::string& s = node_.Scalar();
    if (s == "on" || s == "true" || s == "yes") return true;
    if (s == "off" || s == "false" || s == "no") return false;
  }
  fail("must be on or off");
}

std::string YamlValue::choice(std::span<const std::string_view> choices) const {
  std::vector<std::string> names(choices.begin(), choices.end());
  const std::string word = is_scalar() ? node_.Scalar() : "";
  if (std::find(names.begin(), names.end(), word) != names.end()) return word;
  std::string all;
  for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
  fail("must be one of " + all);
}

std::vector<YamlValue> YamlValue::list() const {
  if (!is_list()) fail("must be a list");
  std::vector<YamlValue> values;
  for (std::size_t i = 0; i < node_.size(); ++i)
    values.push_back({node_[i], file_, path_ + "[" + std::to_string(i) + "]"});
  return values;
}

std::vector<double> YamlValue::numbers(std::size_t count, Bounds bounds) const {
  std::vector<double> values;
  if (is_list())
    for (const auto& value : list()) values.push_back(value.number(bounds));
  if (values.size() != count) fail("must be a list of " + std::to_string(count) + " numbers");
  return values;
}

YamlMap::YamlMap(const YamlValue& value) : value_(value) {
  if (!value.is_map()) value.fail("must be a mapping of keys to values");
}

std::string YamlMap::child_path(std::string_view key) const {
  return value_.path_ + (value_.path_.empty() ? "" : ".") + std::string(key);
}

std::optional<YamlValue> YamlMap::find(std::string_view key) {
  known_.emplace(key);
  const YAML::Node& map = value_.node_;  // const, so that a lookup does not insert
  const YAML::Node child = map[std::string(key)];
  if (!child.IsDefined()) return std::nullopt;
  YamlValue value(child, value_.file_, child_path(key));
  if (child.IsNull()) value.fail("has no value", false);
  return value;
}

YamlValue YamlMap::require(std::string_view key) {
  if (auto value = find(key)) return *value;
  // A suggestion for a misspelt key is better than "is missing".
  for (const auto& entry : value_.node_) {
    const std::string name = entry.first.Scalar();
    if (!known_.contains(name) && nearest_name(name, {std::string(key)}) == key)
      YamlValue(entry.first, value_.file_, child_path(name))
          .fail("unknown key, did you mean " + std::string(key) + "?", false);
  }
  YamlValue(value_.node_, value_.file_, child_path(key)).fail("is missing", false);
}

std::vector<std::string> YamlMap::keys() const {
  std::vector<std::string> names;
  for (const auto& entry : value_.node_) names.push_back(entry.first.Scalar());
  return names;
}

double YamlMap::number_or(std::string_view key, double otherwise, Bounds bounds) {
  const auto value = find(key);
  return value ? value->number(bounds) : otherwise;
}

std::int64_t YamlMap::integer_or(std::string_view key, std::int64_t otherwise, std::int64_t least,
                                 std::int64_t most) {
  const auto value = find(key);
  return value ? value->integer(least, most) : otherwise;
}

std::string YamlMap::text_or(std::string_view key, std::string otherwise) {
  const auto value = find(key);
  return value ? value->text() : std::move(otherwise);
}

bool YamlMap::flag_or(std::string_view key, bool otherwise) {
  const auto value = find(key);
  return value ? value->flag() : otherwise;
}

void YamlMap::done() const {
  for (const auto& entry : value_.node_) {
    const std::string name = entry.first.Scalar();
    if (known_.contains(name)) continue;
    const std::string hint = nearest_name(name, {known_.begin(), known_.end()});
    std::string reason = "unknown key";
    if (!hint.empty()) reason += ", did you mean " + hint + "?";
    YamlValue(entry.first, value_.file_, child_path(name)).fail(reason, false);
  }
}

}  // namespace dmise
