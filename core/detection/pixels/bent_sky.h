#pragma once
#include <vector>

#include "core/detection/pixels/cell_mesh.h"

// The level of a sky that bends, as in the Moon's glow. A median of cells and straight lines
// between them would miss it by several times the error that noise leaves.
namespace dmise {

/// Second derivatives of a level by the cell, xx, xy, yy; 0 where they are not significant.
struct SkyBend {
  float xx = 0.0f, xy = 0.0f, yy = 0.0f;
};

/// Returns the bends of a mesh of levels cell by cell, as far as noise did not make them.
std::vector<SkyBend> sky_bends(const CellMesh& level, const CellMesh& sigma);

/// Whether any is not 0.
bool is_bent(const std::vector<SkyBend>& bends);

/// Returns the median of each cell and its neighbours; at the mesh's edges only of neighbours that
/// have an opposite one, so that gradients are preserved.
CellMesh median_of_cells(const CellMesh& raw);

/// Returns medians, and where the level bends the cells themselves, except cells that are far from
/// a parabola through those around them: of these the parabola.
CellMesh without_sources(const CellMesh& raw, const CellMesh& medians, const CellMesh& sigma,
                         const std::vector<SkyBend>& bends);

/// Returns a mesh of a frame of `columns` x `rows` with four times as many cells each way: a
/// parabola through the cells, each of which is the mean of its pixels.
CellMesh refined(const CellMesh& level, const std::vector<SkyBend>& bends, int columns, int rows);

}  // namespace dmise
