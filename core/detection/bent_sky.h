#pragma once
#include <vector>

#include "core/detection/cell_mesh.h"

// The level of a sky that bends, as in the Moon's glow: a median of cells and straight lines
// between them would miss it by several times what a pixel's noise leaves.
namespace dmise {

/// Second derivatives of a level by the cell, xx, xy, yy; 0 where they are not significant.
struct SkyBend {
  float xx = 0.0f, xy = 0.0f, yy = 0.0f;
};

/// Bends of a mesh of levels against its noise, cell by cell.
std::vector<SkyBend> sky_bends(const CellMesh& level, const CellMesh& sigma);

/// Whether any is not 0.
bool is_bent(const std::vector<SkyBend>& bends);

/// Median of each cell and its neighbours; at the mesh's edges only neighbours with an opposite
/// count, so that gradients are preserved.
CellMesh median_of_cells(const CellMesh& raw);

/// Medians, and where the level bends the cells themselves: but for those that a parabola through
/// the cells around them does not explain.
CellMesh without_sources(const CellMesh& raw, const CellMesh& medians, const CellMesh& sigma,
                         const std::vector<SkyBend>& bends);

/// A mesh of a frame of `columns` x `rows` with four times as many cells each way: a parabola
/// through the cells, of which each is the mean of its pixels.
CellMesh refined(const CellMesh& level, const std::vector<SkyBend>& bends, int columns, int rows);

}  // namespace dmise
