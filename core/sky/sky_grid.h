#pragma once
#include <cstddef>
#include <functional>
#include <vector>

#include "core/base/parallel.h"
#include "core/sky/sky_patch.h"

namespace dmise {

/// A smooth function of pixel position, >= 0: the sky's radiance seen by a camera.
using PixelFunction = std::function<double(double x, double y)>;

/// Fills `out` (columns x rows, row-major) with `f` at every pixel's centre, from a coarse grid:
/// bicubic between nodes some 32 px apart, checked against `f` at the middle of every cell and by
/// the nodes' fourth differences. Where the error may exceed `tolerance` (relative) the cell is cut
/// in four, and so on down to single pixels. `f` is called inside the image only, by any of
/// `threads`. The same bytes for the same input, on any number of them. Returns how often `f` was
/// called.
std::size_t fill_from_grid(int columns, int rows, const PixelFunction& f, double tolerance,
                           float* out, Threads& threads);

/// Fills an image without a grid: `f` at every pixel's centre.
void fill_every_pixel(int columns, int rows, const PixelFunction& f, float* out, Threads& threads);

/// The grid as patches, of which the pixels are evaluations, to be drawn elsewhere. Later ones
/// cover earlier ones.
std::vector<SkyPatch> patches_of_grid(int columns, int rows, const PixelFunction& f,
                                      double tolerance, Threads& threads);

}  // namespace dmise
