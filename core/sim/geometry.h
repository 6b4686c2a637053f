#pragma once
#include <variant>

#include "core/photometry/diffuse_sphere.h"

namespace dmise {

/// The shape of an object, and what its surface does with light. To add one: write its struct where
/// its light is computed, list it here, give it a field in proto/ and a case in nodes/wire and in
/// the object layer.
using Geometry = std::variant<DiffuseSphere>;

}  // namespace dmise
