#pragma once
#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>

// A product - detection, truth, report of a frame, track, task, world coordinate system - names
// each of its fields once, in `visit_fields(v, product)` beneath its struct. Visitors read and
// write it: JSON (product_json.cpp) and messages (nodes/wire/product_message.h). A JSON line has
// this order. A row is one of
//
//   v(name, member)               `name`: of the field in the message, and the key in JSON
//   v(name, member, key, unit)    a number or list, in `unit` under `key` in JSON
//   v.pair(name, x, name, y, key, unit)     two numbers, an array in JSON
//   v.pair_or_null(is, name, x, ..)         null in JSON unless `is`
//   v.null_unless(is, name, member)         null in JSON unless `is`; readers take what is there
//   v.absent_unless(is, name, member, key)  not in JSON unless `is`; readers take what is there
//   v.constant(key, value)        only in JSON
//   v.notes(key, texts)           only in JSON, where there are some
//
// A time `name` is name_ns in messages and JSON, with name_utc beside it there. An enumeration is
// its name in JSON, by `names_of`. An optional number is absent where it is empty; so is an
// optional struct with fields of its own, which is an object in JSON and a message in messages.
namespace dmise {

/// T or const T: `visit_fields` serves readers and writers.
template <class D, class T>
concept MaybeConst = std::same_as<std::remove_const_t<D>, T>;

/// A visitor for the question whether a type has fields.
struct FieldProbe {};

/// An enumeration whose values have names in products.
template <class E>
concept Named = std::is_enum_v<E> && requires(E e) {
  { names_of(e) } -> std::convertible_to<std::span<const char* const>>;
};

/// A struct with fields of its own within a product.
template <class T>
concept HasFields = requires(const T& value, FieldProbe& probe) {
  visit_fields(probe, value);
};

template <Named E>
const char* name_of(E value) {
  return names_of(value)[std::size_t(value)];
}

}  // namespace dmise
