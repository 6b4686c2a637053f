#pragma once
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace dmise {

/// Writes one JSON value; keys keep the order of the calls. A double is the shortest text that
/// reads back to the same bits, so equal values give equal bytes. Throws `Error` with the key for
/// NaN and infinities.
class JsonWriter {
 public:
  JsonWriter& begin_object() { return open('{'); }
  JsonWriter& end_object() { return close('}'); }
  JsonWriter& begin_array() { return open('['); }
  JsonWriter& end_array() { return close(']'); }
  JsonWriter& key(std::string_view name);
  JsonWriter& value(double number);
  JsonWriter& value(std::int64_t number) { return raw(std::to_string(number)); }
  JsonWriter& value(std::uint64_t number) { return raw(std::to_string(number)); }
  JsonWriter& value(int number) { return value(std::int64_t(number)); }
  JsonWriter& value(unsigned number) { return value(std::uint64_t(number)); }
  JsonWriter& value(bool flag) { return raw(flag ? "true" : "false"); }
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& null() { return raw("null"); }
  /// Writes null where there is none.
  JsonWriter& value(const std::optional<double>& number) {
    return number ? value(*number) : null();
  }
  /// Inserts `text`, which must be valid JSON.
  JsonWriter& raw(std::string_view text);

  template <class T>
  JsonWriter& field(std::string_view name, const T& v) {
    key(name);
    return value(v);
  }
  /// A field that is an array.
  template <class Values = std::initializer_list<double>>
  JsonWriter& list(std::string_view name, const Values& values) {
    key(name).begin_array();
    for (const auto& v : values) value(v);
    return end_array();
  }

  const std::string& text() const { return text_; }
  std::string take() { return std::move(text_); }

 private:
  JsonWriter& open(char bracket);
  JsonWriter& close(char bracket);
  void separate();
  std::string text_;
  std::string last_key_;
  bool need_comma_ = false;
};

}  // namespace dmise
