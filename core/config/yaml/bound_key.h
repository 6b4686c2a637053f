#pragma once
#include <optional>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>

#include "core/base/files/json.h"
#include "core/base/formatted.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {

namespace bound_key {

template <class>
struct MemberOf;
template <class S, class T>
struct MemberOf<T S::*> {
  using Settings = S;
  using Value = T;
};

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

/// The default of a key, as a YAML file has it; "" for none.
template <class T>
std::string text_of(const T& value, const Forms& forms) {
  if constexpr (is_optional<T>)
    return value ? text_of(*value, forms) : "";
  else if constexpr (std::is_same_v<T, bool>)
    return value ? "on" : "off";
  else if constexpr (std::is_enum_v<T>)
    return forms.front().words.at(std::size_t(value));
  else if constexpr (std::is_integral_v<T>)
    return std::to_string(value);
  else
    return shortest_text(value);
}

template <class T>
void read(const YamlValue& value, T& to) {
  if constexpr (is_optional<T>)
    read(value, to.emplace());
  else if constexpr (std::is_same_v<T, bool>)
    to = value.flag();
  else if constexpr (std::is_enum_v<T>)
    to = T(value.chosen_index());
  else if constexpr (std::is_integral_v<T>)
    to = T(value.integer());
  else
    to = value.number();
}

template <class T>
void write(JsonWriter& json, const Key& key, const T& value) {
  if constexpr (is_optional<T>) {
    if (value) write(json, key, *value);
  } else if constexpr (std::is_enum_v<T>) {
    json.field(key.name, key.forms.front().words.at(std::size_t(value)));
  } else {
    json.field(key.name, value);
  }
}

}  // namespace bound_key

/// A key that is a member of a struct of settings: a number, a flag, or a choice whose words are in
/// the order of the enumerators; or one of them that may be left out. The row says name, form and
/// meaning; the default is that of the struct, and `otherwise` says in words what none means.
/// `read_bound` and `write_bound` read and write it.
template <auto member>
Key bound(std::string name, Forms forms, std::string what, std::string otherwise = {}) {
  using Member = bound_key::MemberOf<decltype(member)>;
  using Settings = typename Member::Settings;
  if (otherwise.empty()) otherwise = bound_key::text_of(Settings().*member, forms);
  Key key = optional(std::move(name), std::move(forms), std::move(what), std::move(otherwise));
  key.binding = {&typeid(Settings),
                 [](const YamlValue& value, void* settings) {
                   bound_key::read(value, static_cast<Settings*>(settings)->*member);
                 },
                 [](JsonWriter& json, const Key& row, const void* settings) {
                   bound_key::write(json, row, static_cast<const Settings*>(settings)->*member);
                 },
                 [](const void* settings) {
                   return static_cast<const Settings*>(settings)->*member == Settings().*member;
                 }};
  return key;
}

/// Reads the keys of the map's section that are bound to members of `settings`. Those that are not
/// given keep what it has.
template <class Settings>
void read_bound(YamlMap& map, Settings& settings) {
  for (const Key& key : map.section().keys)
    if (key.binding.settings && *key.binding.settings == typeid(Settings))
      if (const auto value = map.find(key.name)) key.binding.read(*value, &settings);
}

/// Writes the keys of a section that are bound to members of `settings`, in their order.
template <class Settings>
void write_bound(JsonWriter& json, const Section& section, const Settings& settings) {
  for (const Key& key : section.keys)
    if (key.binding.settings && *key.binding.settings == typeid(Settings) &&
        !(key.binding.later && key.binding.is_default(&settings)))
      key.binding.write(json, key, &settings);
}

}  // namespace dmise
