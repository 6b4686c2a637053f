#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/image.h"

namespace dmise {

/// The pixels of one object.
struct ObjectMask {
  int columns = 0, rows = 0;                     // size of the image
  std::vector<std::uint32_t> pixels;             // row * columns + column, ascending
  double covered_e = 0.0, all_e = 0.0;           // light in these pixels, and in the image
  int left = 0, top = 0, right = 0, bottom = 0;  // first pixel, one past the last

  bool empty() const { return pixels.empty(); }
};

/// Least share of an object's light in the image that its mask holds.
inline constexpr double mask_share = 0.99;

/// Returns the fewest pixels that hold `share` of an object's light, the first of equally bright
/// ones; none without light.
ObjectMask mask_of(const ExpectedElectronImage& light, double share = mask_share);

/// COCO's compressed run lengths: column by column, off and on in turn, each as the difference from
/// the length two before it, in groups of 5 bits. Source: pycocotools, maskApi.c, rleToString.
std::string coco_counts(const ObjectMask& mask);

/// Signal-to-noise ratio of the optimal linear filter: sqrt(sum (s / sigma)^2) over all pixels,
/// with the expected light `s` of the object and the expected noise `sigma` of a pixel [e-].
double optimal_snr(const ExpectedElectronImage& light, const ElectronImage& noise);

/// Number of the object at each pixel: 0 none, k the k-th; the brightest where masks overlap.
using LabelImage = Image<std::uint16_t, struct LabelCarrier>;

/// Builds a label image.
class LabelPlane {
 public:
  LabelPlane(int columns, int rows);
  /// `label` from 1. Throws `Error` beyond 65535.
  void add(std::size_t label, const ObjectMask& mask, const ExpectedElectronImage& light);
  const LabelImage& image() const { return labels_; }

 private:
  LabelImage labels_;
  ExpectedElectronImage brightest_;
};

}  // namespace dmise
