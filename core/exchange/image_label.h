#pragma once
#include <optional>
#include <vector>

#include "core/exchange/run_products.h"
#include "core/products/detection.h"
#include "core/products/truth.h"

namespace dmise {

/// A box in an image; the first pixel extends from -0.5 to 0.5.
struct PixelBox {
  double left_px = 0.0, top_px = 0.0, right_px = 0.0, bottom_px = 0.0;
};

/// Where a source's light is in a frame. Its box and outline contain all places within
/// `margin_px` of its trail that are in the image.
struct ImageLabel {
  PixelPosition start, middle, end;  // may lie outside the image
  double margin_px = 0.0;
  PixelBox box;
};

/// Half the width of labels, in FWHM of the point spread: 99.8 % of a Gaussian's light.
inline constexpr double label_margin_fwhm = 1.5;

/// The label of an object or detection; none if it is outside the image.
std::optional<ImageLabel> label_of(const Truth& truth, const RunProducts& run);
std::optional<ImageLabel> label_of(const Detection& detection, const RunProducts& run);

/// Corners of the band around the trail, clipped to an image of this size; none outside it.
std::vector<PixelPosition> outline_of(const ImageLabel& label, int columns, int rows);

/// Area of a polygon [px^2].
double area_px2(const std::vector<PixelPosition>& polygon);

}  // namespace dmise
