#pragma once
#include <variant>

#include "core/photometry/diffuse_sphere.h"

namespace dmise {

/// Shape of an object and its reflectance. To add one: write its struct where its light is
/// computed, list it here, give it a field in proto/ and a case in nodes/wire and in the object
/// layer.
using Geometry = std::variant<DiffuseSphere>;

}  // namespace dmise
