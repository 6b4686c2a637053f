#pragma once
#include <glm/glm.hpp>

#include "core/frames/vec.h"

// GLM types of the renderer's geometry. They are used only inside the renderer; outside, the frame
// of a vector is part of its type.
namespace dmise {

template <class F>
glm::dvec3 glm_of(const Vec<F>& v) {
  return {v.x, v.y, v.z};
}

/// GLM's matrices are arrays of columns.
template <class To, class From>
glm::dmat3 glm_of(const Rotation<To, From>& rotation) {
  glm::dmat3 columns;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) columns[j][i] = rotation.m[std::size_t(i)][std::size_t(j)];
  return columns;
}

}  // namespace dmise
