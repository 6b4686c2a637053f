#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <typeinfo>
#include <vector>

namespace dmise {

/// Range of a number, and the reason for it in messages.
struct Bounds {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_open = false;  // `least` itself is refused

  static Bounds positive() { return {.least = 0.0, .least_open = true}; }
  static Bounds between(double least, double most) { return {.least = least, .most = most}; }
  static Bounds above(double least, double most) {
    return {.least = least, .most = most, .least_open = true};
  }
};

struct Section;

/// One form that a value of a YAML file may have.
struct Form {
  enum class Kind { number, integer, text, time, flag, choice, list, map };

  Kind kind = Kind::text;
  Bounds bounds{};                        // range, if a number
  std::int64_t least = 0, most = 0;       // range, if a whole number
  std::vector<std::string> words{};       // choices; if a text, those that editors suggest
  std::size_t fewest = 0, greatest = 0;   // limits of a list's length; greatest 0: no limit
  std::vector<Form> items{};              // forms of each item, if a list
  const Section& (*section)() = nullptr;  // keys, if a map
};
using Forms = std::vector<Form>;

class JsonWriter;
class YamlValue;

struct Key;

/// The member of a struct of settings that a key is bound to (`bound_key.h`).
struct Binding {
  const std::type_info* settings = nullptr;  // null: none
  void (*read)(const YamlValue& value, void* settings) = nullptr;
  void (*write)(JsonWriter& json, const Key& key, const void* settings) = nullptr;
  bool (*is_default)(const void* settings) = nullptr;
  // The digest has it only where it is no default: it came later, and older digests stay.
  bool later = false;
};

/// A key of a section. `otherwise` is its default, in the text of a YAML file where it is a
/// scalar; empty: none.
struct Key {
  std::string name;
  Forms forms;
  std::string what;  // with the unit, in indicative sentences
  std::string otherwise = {};
  bool required = false;
  Binding binding = {};
};

/// The keys of a mapping: what a reader may ask for, with types and ranges, and what editors and
/// documents say of it. A reader names its section where it opens the mapping; it can then ask for
/// no other key and no other type, and takes ranges from here.
struct Section {
  std::string name;  // unique among all sections
  std::string what;
  std::vector<Key> keys;
  std::optional<Key> any_other = {};  // for keys that users choose: `name` is their pattern

  const Key* find(std::string_view key) const;
};

Forms operator|(Forms a, const Forms& b);

// Forms of values, for tables.
namespace form {

Forms number(double least, double most);
Forms above(double least, double most);  // `least` itself is refused
Forms positive();
Forms not_negative();
Forms integer(std::int64_t least, std::int64_t most);
Forms seed();  // for random numbers: 0 to 2^63 - 1
Forms text(std::vector<std::string> suggested = {});
Forms time();  // UTC
Forms flag();
Forms choice(std::vector<std::string> words);
Forms list(Forms items, std::size_t fewest = 0);
Forms numbers(std::size_t count, double least, double most);  // a list of them
Forms positive_numbers(std::size_t count, double most);
Forms map(const Section& (*section)());

}  // namespace form

/// "[unit] what it is" of a FITS comment as a sentence: "What it is [unit]."
std::string sentence_of(std::string_view comment);

Key required(std::string name, Forms forms, std::string what);
Key optional(std::string name, Forms forms, std::string what, std::string otherwise = {});

/// Marks a bound key that came after runs were made without it.
Key later(Key key);

/// The keys of a section with those that it shares with others, after them.
std::vector<Key> with_keys(std::vector<Key> keys, std::vector<Key> shared);

}  // namespace dmise
