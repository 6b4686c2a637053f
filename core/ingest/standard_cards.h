#pragma once
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/image/fits_cards.h"
#include "core/products/frame_notes.h"

namespace dmise {

/// The cards of another camera's header. A value that is not what its keyword stands for is noted
/// as missing, with the value; nothing is read as something else.
class StandardCards {
 public:
  StandardCards(const FitsValues& values, FrameNotes& notes) : values_(values), notes_(notes) {}

  bool has(const std::string& key) const {
    read_.insert(key);
    return values_.contains(key);
  }
  /// Printable ASCII; empty if the keyword is missing or blank.
  std::string text(const std::string& key) const;
  std::optional<double> number(const std::string& key) const;

  /// A keyword and its value.
  template <class Value>
  struct Named {
    std::string key;
    Value value;
  };
  /// The first of several keywords that is there and reads as a number or a text.
  std::optional<Named<double>> first_number(std::initializer_list<const char*> keys) const;
  std::optional<Named<std::string>> first_text(std::initializer_list<const char*> keys) const;

  /// Degrees, as a number or as "d m s" with blanks, colons or signs of units, with N, S, E or W
  /// after it; a fourth part is hundredths of a second, which is noted. `hours`: parts are hours.
  std::optional<double> angle_deg(const std::string& key, bool hours) const;

  void missing(const std::string& text) const { notes_.missing.push_back(text); }
  void assumed(const std::string& text) const { notes_.assumed.push_back(text); }
  /// Notes that a keyword's value is not used: "KEY: reason, got VALUE".
  void reject(const std::string& key, const std::string& reason) const;

  /// Whether anything has asked for a keyword so far.
  bool was_read(const std::string& key) const { return read_.contains(key); }
  /// Throws `ConfigError` "NAME: KEY: reason, got VALUE" if a keyword's value was rejected.
  void require_accepted(const std::string& key, const std::string& name) const;

 private:
  const FitsValues& values_;
  FrameNotes& notes_;
  mutable std::set<std::string> read_;
  mutable std::map<std::string, std::string> rejected_;  // why, by keyword
};

}  // namespace dmise
