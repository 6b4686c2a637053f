#include "core/config/yaml/yaml_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/config/yaml/distribution.h"
#include "core/config/yaml/search_path.h"
#include "core/config/yaml/yaml_limits.h"
#include "core/config/yaml/yaml_syntax.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

[[noreturn]] void section_lacks(const std::string& what) {
  throw std::logic_error("core/config: the section says nothing of " + what);
}

/// Whether a section names a key, which its reader did not ask for beside the others that are
/// given.
bool names(const Section* section, const std::string& key) {
  return section && std::ranges::find(section->keys, key, &Key::name) != section->keys.end();
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
    throw ConfigError(syntax_complaint(text, file, e));
  }
}

std::string YamlValue::where() const { return place_of(*file_, node_.Mark()); }

std::string YamlValue::place() const {
  return where() + (path_.empty() ? "" : ": " + printable(path_));
}

std::string YamlValue::complaint(const std::string& reason, bool show_value) const {
  constexpr std::size_t max_shown_bytes = 200;
  std::string text = place() + ": " + reason;
  if (show_value) {
    text += ", got ";
    if (node_.IsScalar()) {
      text += node_.Scalar().empty() ? "''" : printable(node_.Scalar(), max_shown_bytes);
    } else {
      text += node_.IsMap() ? "a mapping" : node_.IsSequence() ? "a list" : "nothing";
    }
  }
  return text;
}

void YamlValue::fail(const std::string& reason, bool show_value) const {
  throw ConfigError(complaint(reason, show_value));
}

const Form* YamlValue::form(Form::Kind kind) const {
  if (!forms_) return nullptr;
  for (const Form& form : *forms_)
    if (form.kind == kind) return &form;
  section_lacks("a form that is read of " + path_);
}

bool YamlValue::is_like_number() const {
  return is_scalar() && text().find_first_not_of("+-.0123456789") == std::string::npos;
}

double YamlValue::number() const {
  const Form* is = form(Form::Kind::number);
  return number(is ? is->bounds : Bounds{});
}

double YamlValue::number(Bounds bounds) const {
  form(Form::Kind::number);
  const auto parsed = is_scalar() ? parse_real(node_.Scalar()) : std::nullopt;
  if (!parsed) fail("must be a number");
  const double x = *parsed;
  if (bounds.least_open ? x <= bounds.least : x < bounds.least)
    fail("must be " + std::string(bounds.least_open ? "> " : ">= ") + shortest_text(bounds.least));
  if (x > bounds.most) fail("must be <= " + shortest_text(bounds.most));
  return x;
}

std::int64_t YamlValue::integer() const {
  const Form* is = form(Form::Kind::integer);
  if (!is) section_lacks("the range of " + path_);
  return integer(is->least, is->most);
}

std::int64_t YamlValue::integer(std::int64_t least, std::int64_t most) const {
  form(Form::Kind::integer);
  if (!is_scalar()) fail("must be a whole number");
  const std::string& s = node_.Scalar();
  std::int64_t x = 0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
  const bool too_long = error == std::errc::result_out_of_range;
  if ((error != std::errc{} && !too_long) || end != s.data() + s.size())
    fail("must be a whole number");
  if (too_long ? s.front() == '-' : x < least) fail("must be >= " + std::to_string(least));
  if (too_long || x > most) fail("must be <= " + std::to_string(most));
  return x;
}

std::string YamlValue::text() const {
  if (!is_scalar() || node_.Scalar().empty()) fail("must be a text");
  return node_.Scalar();
}

std::string YamlValue::existing_file() const {
  std::string path = find_beside(text(), file());
  if (path.empty()) fail("there is no such file");
  return path;
}

Utc YamlValue::time() const {
  form(Form::Kind::time);
  const std::string said = text();
  try {
    return parse_utc(said);
  } catch (const BeforeLeapSeconds&) {
    fail("must not be before 1972, when UTC was not yet whole seconds from TAI");
  } catch (const Error&) {
    fail("must be a UTC time such as 2018-01-21T00:30:00Z");
  }
}

bool YamlValue::flag() const {
  form(Form::Kind::flag);
  if (is_scalar()) {
    const std::string& s = node_.Scalar();
    if (s == "on" || s == "true" || s == "yes") return true;
    if (s == "off" || s == "false" || s == "no") return false;
  }
  const bool or_map = forms_ && std::ranges::any_of(*forms_, [](const Form& form) {
                        return form.kind == Form::Kind::map;
                      });
  fail((or_map ? "must be on, off or a mapping" : "must be on or off") +
       did_you_mean(is_scalar() ? text() : "", {"on", "off"}));
}

std::string YamlValue::choice() const {
  const Form* is = form(Form::Kind::choice);
  if (!is) section_lacks("the choices of " + path_);
  return choice(std::vector<std::string_view>(is->words.begin(), is->words.end()));
}

std::string YamlValue::choice(std::span<const std::string_view> choices) const {
  form(Form::Kind::choice);
  const std::vector<std::string> names(choices.begin(), choices.end());
  const std::string word = is_scalar() ? node_.Scalar() : "";
  if (std::ranges::find(names, word) == names.end())
    fail("must be one of " + joined(names) + did_you_mean(word, names));
  return word;
}

std::size_t YamlValue::choice_index(std::size_t count) const {
  if (form(Form::Kind::choice)->words.size() != count)
    section_lacks("the meaning of each choice of " + path_);
  return chosen_index();
}

std::size_t YamlValue::chosen_index() const {
  const std::string word = choice();
  const auto& words = form(Form::Kind::choice)->words;
  return std::size_t(std::ranges::find(words, word) - words.begin());
}

std::vector<YamlValue> YamlValue::list() const {
  const Form* is = form(Form::Kind::list);
  if (!is_list()) fail("must be a list");
  std::vector<YamlValue> values;
  for (std::size_t i = 0; i < node_.size(); ++i)
    values.push_back(
        {node_[i], file_, path_ + "[" + std::to_string(i) + "]", is ? &is->items : nullptr});
  return values;
}

std::vector<double> YamlValue::numbers() const {
  const Form* is = form(Form::Kind::list);
  if (!is) section_lacks("the range of " + path_);
  std::vector<double> values;
  if (is_list() || is->greatest == 0)
    for (const auto& value : list()) values.push_back(value.number());
  if (is->greatest > 0 && values.size() != is->greatest)
    fail("must be a list of " + std::to_string(is->greatest) + " numbers");
  return values;
}

YamlValue load_preset(const std::string& kind, const YamlValue& value) {
  const std::string name = value.text(), path = find_preset(kind + "s", name, value.file());
  if (!path.empty()) {
    const YamlValue preset = YamlValue::load(path);
    refuse_distributions(preset, "presets hold none, only the scenario itself does");
    return preset;
  }
  const auto names = preset_names(kind + "s");
  value.fail("no such " + kind + did_you_mean(name, names) + " (a path to a YAML file, or one of " +
             joined(names) + ")");
}

YamlMap::YamlMap(const YamlValue& value) : value_(value) {
  if (!value.is_map()) value.fail("must be a mapping of keys to values");
}

YamlMap::YamlMap(const YamlValue& value, const Section& section) : YamlMap(value) {
  section_ = &section;
  if (!value.forms_) return;
  const auto is_section = [&](const Form& form) {
    return form.kind == Form::Kind::map && &form.section() == &section;
  };
  if (std::none_of(value.forms_->begin(), value.forms_->end(), is_section))
    section_lacks("the mapping that is read of " + value.path_);
}

std::string YamlMap::child_path(std::string_view key) const {
  return value_.path_ + (value_.path_.empty() ? "" : ".") + std::string(key);
}

std::optional<YamlValue> YamlMap::find(std::string_view key) {
  known_.emplace(key);
  const Key* is = section_ ? section_->find(key) : nullptr;
  if (section_ && !is) section_lacks(section_->name + ": " + std::string(key));
  return look_up(key, is ? &is->forms : nullptr);
}

void YamlMap::refuse(std::string_view key, const std::string& reason) {
  if (const auto value = look_up(key, nullptr)) value->fail(reason, false);
}

std::optional<YamlValue> YamlMap::look_up(std::string_view key, const Forms* forms) {
  const YAML::Node& map = value_.node_;  // const, so that a lookup does not insert
  const YAML::Node child = map[std::string(key)];
  if (!child.IsDefined()) return std::nullopt;
  YamlValue value(child, value_.file_, child_path(key), forms);
  if (child.IsNull()) value.fail("has no value", false);
  return value;
}

YamlValue YamlMap::require(std::string_view key) {
  if (auto value = find(key)) return *value;
  // A suggestion for a misspelt key is better than "is missing".
  for (const auto& entry : value_.node_) {
    const std::string name = entry.first.Scalar();
    if (!known_.contains(name) && !names(section_, name) &&
        nearest_name(name, {std::string(key)}) == key)
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

YamlValue YamlMap::given_or_default(std::string_view key) {
  const Key* is = section_ ? section_->find(key) : nullptr;
  if (!find(key) && is && !is->otherwise.empty())
    return {YAML::Node(is->otherwise), value_.file_, child_path(key), &is->forms};
  return require(key);
}

void YamlMap::done() const {
  for (const auto& entry : value_.node_) {
    const std::string name = entry.first.Scalar();
    if (known_.contains(name)) continue;
    const YamlValue key(entry.first, value_.file_, child_path(name));
    if (names(section_, name)) key.fail("goes with other keys or values than those given", false);
    key.fail("unknown key" + did_you_mean(name, {known_.begin(), known_.end()}), false);
  }
}

}  // namespace dmise
