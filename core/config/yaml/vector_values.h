#pragma once
#include <cmath>
#include <string>

#include "core/config/yaml/yaml_reader.h"
#include "core/frames/quaternion.h"
#include "core/frames/vec.h"

// Vectors and rotations in YAML files.
namespace dmise {
namespace form {

/// A vector of any length but 0.
inline Forms direction() { return numbers(3, -1e9, 1e9); }
/// [w, x, y, z]
inline Forms quaternion() { return numbers(4, -2.0, 2.0); }

}  // namespace form

template <class F>
Vec<F> vector_of(const YamlValue& value) {
  const auto v = value.numbers();
  return {v[0], v[1], v[2]};
}

/// The unit vector along a `form::direction`.
template <class F>
Vec<F> direction_of(const YamlValue& value) {
  const auto direction = vector_of<F>(value);
  if (!(norm(direction) > 0)) value.fail("must not be zero", false);
  return unit(direction);
}

/// The rotation of a `form::quaternion`, which may be up to a factor of two from unit length.
template <class To, class From>
Rotation<To, From> rotation_in(const YamlValue& value) {
  const auto q = value.numbers();
  const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  if (!(length > 0.5 && length < 2.0))
    value.fail("must be a unit quaternion [w, x, y, z], its length is " + std::to_string(length),
               false);
  return rotation_of<To, From>({q[0], q[1], q[2], q[3]});
}

}  // namespace dmise
