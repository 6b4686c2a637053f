#pragma once
#include <optional>
#include <string_view>
#include <utility>

namespace dmise {

/// A value, or the one reason why there is none. The reason is a text of static storage.
template <class T>
struct Outcome {
  std::optional<T> value;
  std::string_view reason;  // empty if there is a value

  Outcome(T v) : value(std::move(v)) {}  // NOLINT: a value is an outcome
  static Outcome refused(std::string_view reason) { return Outcome(reason, 0); }

  explicit operator bool() const { return value.has_value(); }
  const T& operator*() const { return *value; }
  T& operator*() { return *value; }
  const T* operator->() const { return &*value; }
  T* operator->() { return &*value; }

 private:
  Outcome(std::string_view why, int) : reason(why) {}
};

}  // namespace dmise
