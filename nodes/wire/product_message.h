#pragma once
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/reflection.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/error.h"
#include "core/frames/quaternion.h"
#include "core/frames/vec.h"
#include "core/products/detection.h"
#include "core/products/frame_report.h"
#include "core/products/task.h"
#include "core/products/track.h"
#include "core/products/truth.h"
#include "nodes/wire/codecs.h"

// Products as messages, by the fields that `visit_fields` names: a field of a message has the name
// of the member. Private to nodes/wire.
namespace dmise {

/// A field of a message by its name and what follows it. Both must be literals: fields are
/// remembered by their addresses. Throws `std::logic_error` for a name that the message lacks.
const google::protobuf::FieldDescriptor& field_of(const google::protobuf::Message& message,
                                                  const char* name, const char* ending = "");
/// A whole number, flag or enumeration of a field, whatever its width.
void set_whole(google::protobuf::Message& message, const google::protobuf::FieldDescriptor& field,
               std::int64_t value);
std::int64_t whole_of(const google::protobuf::Message& message,
                      const google::protobuf::FieldDescriptor& field);

/// Writes a product into a message.
class MessageWriter {
 public:
  explicit MessageWriter(google::protobuf::Message& message)
      : message_(message), reflection_(*message.GetReflection()) {}

  template <class T>
  void operator()(const char* name, const T& member, const char* = nullptr, double = 1.0) {
    put(name, member);
  }
  void pair(const char* x_name, double x, const char* y_name, double y, const char*, double = 1.0) {
    put(x_name, x);
    put(y_name, y);
  }
  void pair_or_null(bool, const char* x_name, double x, const char* y_name, double y,
                    const char* key) {
    pair(x_name, x, y_name, y, key);
  }
  void constant(const char*, const char*) {}
  void notes(const char*, const std::vector<std::string>&) {}
  template <class T>
  void null_unless(bool, const char* name, const T& member) {
    put(name, member);
  }
  template <class T>
  void absent_unless(bool, const char* name, const T& member, const char* = nullptr) {
    put(name, member);
  }
  void fits_plane(const char* name, const Projection& projection, bool) {
    put(name, std::uint32_t(projection.index()));
    put_list("coefficients", projection.coefficients());
  }
  void lens(const char* name, const std::optional<Projection>& lens) {
    if (!lens) return;
    put(name, std::uint32_t(lens->index()));
    put_list("lens_coefficients", lens->coefficients());
  }

 private:
  void put(const char* name, double value) {
    reflection_.SetDouble(&message_, &field_of(message_, name), value);
  }
  template <class T>
  requires std::integral<T> || std::is_enum_v<T>
  void put(const char* name, T value) {
    set_whole(message_, field_of(message_, name), std::int64_t(value));
  }
  void put(const char* name, const std::string& value) {
    reflection_.SetString(&message_, &field_of(message_, name), value);
  }
  void put(const char* name, SimTime time) {
    reflection_.SetInt64(&message_, &field_of(message_, name, "_ns"), time.ns);
  }
  void put(const char* name, const std::optional<double>& value) {
    if (value) put(name, *value);
  }
  template <class F>
  void put(const char* name, const Vec<F>& v) {
    put_list(name, std::array{v.x, v.y, v.z});
  }
  void put(const char* name, const std::optional<Quaternion>& q) {
    if (q) put_list(name, std::array{q->w, q->x, q->y, q->z});
  }
  template <std::size_t N>
  void put(const char* name, const std::array<double, N>& values) {
    put_list(name, values);
  }
  void put(const char* name, const std::vector<double>& values) { put_list(name, values); }
  void put(const char* name, const std::vector<std::string>& texts) {
    for (const std::string& text : texts)
      reflection_.AddString(&message_, &field_of(message_, name), text);
  }
  template <class To, class From>
  void put(const char* name, const Rotation<To, From>& r) {
    for (const auto& row : r.m) put_list(name, row);
  }
  template <HasFields T>
  void put(const char* name, const T& part) {
    MessageWriter writer(*reflection_.MutableMessage(&message_, &field_of(message_, name)));
    visit_fields(writer, part);
  }
  template <HasFields T>
  void put(const char* name, const std::optional<T>& part) {
    if (part) put(name, *part);
  }
  template <HasFields T>
  void put(const char* name, const std::vector<T>& parts) {
    put_parts(name, parts);
  }
  template <HasFields T, std::size_t N>
  void put(const char* name, const std::optional<std::array<T, N>>& parts) {
    if (parts) put_parts(name, *parts);
  }
  template <class Parts>
  void put_parts(const char* name, const Parts& parts) {
    for (const auto& part : parts) {
      MessageWriter writer(*reflection_.AddMessage(&message_, &field_of(message_, name)));
      visit_fields(writer, part);
    }
  }
  template <class Numbers>
  void put_list(const char* name, const Numbers& numbers) {
    const auto field =
        reflection_.GetMutableRepeatedFieldRef<double>(&message_, &field_of(message_, name));
    for (const double number : numbers) field.Add(number);
  }

  google::protobuf::Message& message_;
  const google::protobuf::Reflection& reflection_;
};

/// Reads a product from a message. Throws `Refused` for a value that the product can't have.
class MessageReader {
 public:
  /// `path` goes before the names of fields in refusals: "wcs."
  explicit MessageReader(const google::protobuf::Message& message, std::string path = "")
      : message_(message), reflection_(*message.GetReflection()), path_(std::move(path)) {}

  template <class T>
  void operator()(const char* name, T& member, const char* = nullptr, double = 1.0) {
    take(name, member);
  }
  void pair(const char* x_name, double& x, const char* y_name, double& y, const char*,
            double = 1.0) {
    take(x_name, x);
    take(y_name, y);
  }
  void pair_or_null(bool, const char* x_name, double& x, const char* y_name, double& y,
                    const char* key) {
    pair(x_name, x, y_name, y, key);
  }
  void constant(const char*, const char*) {}
  void notes(const char*, std::vector<std::string>&) {}
  template <class T>
  void null_unless(bool, const char* name, T& member) {
    take(name, member);
  }
  template <class T>
  void absent_unless(bool, const char* name, T& member, const char* = nullptr) {
    take(name, member);
  }
  void fits_plane(const char* name, Projection& projection, bool) {
    projection = take_projection(name, "coefficients");
    if (!projection.row().fits_code) refuse(name, "must be one that FITS has");
  }
  void lens(const char* name, std::optional<Projection>& lens) {
    if (reflection_.HasField(message_, &field_of(message_, name)))
      lens = take_projection(name, "lens_coefficients");
  }

 private:
  [[noreturn]] void refuse(const char* name, const std::string& reason) const {
    throw Refused(Refusal::value, path_ + name + ": " + reason);
  }
  void take(const char* name, double& value) const {
    value = reflection_.GetDouble(message_, &field_of(message_, name));
  }
  template <std::integral T>
  void take(const char* name, T& value) const {
    value = T(whole_of(message_, field_of(message_, name)));
  }
  template <Named E>
  void take(const char* name, E& value) const {
    const std::int64_t number = whole_of(message_, field_of(message_, name));
    if (number < 0 || number >= std::int64_t(names_of(value).size())) refuse(name, "unknown");
    value = E(number);
  }
  void take(const char* name, std::string& value) const {
    value = reflection_.GetString(message_, &field_of(message_, name));
  }
  void take(const char* name, SimTime& time) const {
    time.ns = reflection_.GetInt64(message_, &field_of(message_, name, "_ns"));
  }
  void take(const char* name, std::optional<double>& value) const {
    if (reflection_.HasField(message_, &field_of(message_, name))) take(name, value.emplace());
  }
  template <class F>
  void take(const char* name, Vec<F>& vector) const {
    vector = take_vec<F>(list(name), (path_ + name).c_str());
  }
  void take(const char* name, std::optional<Quaternion>& value) const {
    const auto numbers = list(name);
    if (numbers.empty()) return;
    const auto q = dmise::take<4>(numbers, (path_ + name).c_str());
    value = Quaternion{q[0], q[1], q[2], q[3]};
  }
  template <std::size_t N>
  void take(const char* name, std::array<double, N>& values) const {
    values = dmise::take<N>(list(name), (path_ + name).c_str());
  }
  void take(const char* name, std::vector<double>& values) const {
    const auto numbers = list(name);
    values.assign(numbers.begin(), numbers.end());
  }
  void take(const char* name, std::vector<std::string>& texts) const {
    const auto all =
        reflection_.GetRepeatedFieldRef<std::string>(message_, &field_of(message_, name));
    texts.assign(all.begin(), all.end());
  }
  template <class To, class From>
  void take(const char* name, Rotation<To, From>& r) const {
    const auto values = dmise::take<9>(list(name), (path_ + name).c_str());
    for (std::size_t i = 0; i < 9; ++i) r.m[i / 3][i % 3] = values[i];
  }
  template <HasFields T>
  void take(const char* name, T& part) const {
    MessageReader reader(reflection_.GetMessage(message_, &field_of(message_, name)),
                         path_ + name + ".");
    visit_fields(reader, part);
  }
  template <HasFields T>
  void take(const char* name, std::optional<T>& part) const {
    if (reflection_.HasField(message_, &field_of(message_, name))) take(name, part.emplace());
  }
  template <HasFields T>
  void take(const char* name, std::vector<T>& parts) const {
    const auto& field = field_of(message_, name);
    parts.resize(std::size_t(reflection_.FieldSize(message_, &field)));
    for (std::size_t i = 0; i < parts.size(); ++i) {
      MessageReader reader(reflection_.GetRepeatedMessage(message_, &field, int(i)), path_);
      visit_fields(reader, parts[i]);
    }
  }
  template <HasFields T, std::size_t N>
  void take(const char* name, std::optional<std::array<T, N>>& parts) const {
    std::vector<T> all;
    take(name, all);
    if (all.empty()) return;
    if (all.size() != N)
      throw Refused(Refusal::payload, path_ + name + ": must be " + std::to_string(N) + ", got " +
                                          std::to_string(all.size()));
    std::ranges::copy(all, parts.emplace().begin());
  }
  google::protobuf::RepeatedFieldRef<double> list(const char* name) const {
    return reflection_.GetRepeatedFieldRef<double>(message_, &field_of(message_, name));
  }
  Projection take_projection(const char* name, const char* coefficients) const {
    std::uint32_t index = 0;
    std::vector<double> numbers;
    take(name, index);
    take(coefficients, numbers);
    try {
      return Projection::make(index, numbers);
    } catch (const Error& error) {
      refuse(name, error.what());
    }
  }

  const google::protobuf::Message& message_;
  const google::protobuf::Reflection& reflection_;
  std::string path_;
};

template <class Product>
void put_product(google::protobuf::Message& message, const Product& product) {
  MessageWriter writer(message);
  visit_fields(writer, product);
}

template <class Product>
Product take_product(const google::protobuf::Message& message) {
  Product product;
  MessageReader reader(message);
  visit_fields(reader, product);
  return product;
}

}  // namespace dmise
