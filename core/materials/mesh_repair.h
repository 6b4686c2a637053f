#pragma once
#include <string>
#include <vector>

#include "core/materials/mesh.h"

namespace dmise {

/// Where each triangle of a mesh comes from, for messages: `file:line`.
struct MeshLines {
  std::string file;
  std::vector<std::uint32_t> line;  // one a triangle

  std::string of(std::size_t triangle) const { return file + ":" + std::to_string(line[triangle]); }
};

/// Makes a mesh one that light can be computed with, and tells what had to be done, one line each:
///  - facets without area (below 1e-9 of the square of their longest edge) are left out;
///  - a closed surface whose facets disagree in their sense of turning, or that is inside out, is
///    turned to face outwards;
///  - an open surface, or one that has no outside, is a sheet: each of its facets gets a back of
///    the same material.
/// Surfaces are told apart by their edges; vertices at equal places count as one. Throws
/// `ConfigError` when no facet is left.
std::vector<std::string> repair(Mesh& mesh, MeshLines lines);

}  // namespace dmise
