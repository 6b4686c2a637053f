#pragma once
#include <string>
#include <vector>

#include "core/materials/mesh.h"

namespace dmise {

/// Source line of each triangle, for messages: `file:line`.
struct MeshLines {
  std::string file;
  std::vector<std::uint32_t> line;  // one for each triangle

  std::string of(std::size_t triangle) const { return file + ":" + std::to_string(line[triangle]); }
};

/// Repairs a mesh for radiometry and returns one line per repair:
/// - facets without area (below 1e-9 of the square of their longest edge) are dropped;
/// - a closed surface with inconsistently oriented facets, or inside out, is turned to face
///   outwards;
/// - an open surface, or one without an outside, is a sheet: each facet gets a back of the same
///   material.
/// Surfaces are connected components of shared edges; vertices at equal positions count as one,
/// but for those of a panel, which turns without the rest.
/// Throws `ConfigError` if no facet is left.
std::vector<std::string> repair(Mesh& mesh, MeshLines lines);

}  // namespace dmise
