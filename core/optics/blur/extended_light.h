#pragma once
#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/optics/blur/blur_grid.h"

namespace dmise {

/// Light of an extended source by pixels, each integrated over its area, in a window that may reach
/// beyond the frame.
struct ExtendedLight {
  int left = 0, top = 0;  // the frame's pixel at the window's (0, 0)
  ExpectedElectronImage light;
};

/// Adds such light to the frame, blurred by a Gaussian. Its width is right to the second moment
/// from 0.29 px on; narrower ones blur nothing. The window holds what is no farther from the frame
/// than `gaussian_reach_px`.
void add_by_gaussian(const ExtendedLight& source, double sigma_px, ExpectedElectronImage& image,
                     Threads& threads);
int gaussian_reach_px(double sigma_px);

/// Lays such light on a grid whose kernels are divided by a Gaussian of one cell, as deposits are:
/// to the second moment up to an oversampling of 3, beyond it up to 0.08 px2 wider.
void lay_on(const ExtendedLight& source, BlurGrid& grid, Threads& threads);

}  // namespace dmise
