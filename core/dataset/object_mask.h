#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/image.h"

namespace dmise {

/// The pixels of one object.
struct ObjectMask {
  int columns = 0, rows = 0;                     // of the image
  std::vector<std::uint32_t> pixels;             // row * columns + column, ascending
  double covered_e = 0.0, all_e = 0.0;           // light in these pixels, and in the image
  int left = 0, top = 0, right = 0, bottom = 0;  // first pixel, one past the last

  bool empty() const { return pixels.empty(); }
};

/// Share of an object's light in the image that its mask holds, at least.
inline constexpr double mask_share = 0.99;

/// The fewest pixels that hold `share` of the light of an object; of equally bright ones the first.
/// Empty without light.
ObjectMask mask_of(const ExpectedElectronImage& light, double share = mask_share);

/// COCO's compressed run lengths: column by column, off and on in turn, lengths as differences from
/// the one before the last in groups of 5 bits. Source: pycocotools, maskApi.c, rleToString.
std::string coco_counts(const ObjectMask& mask);

/// Signal-to-noise ratio of the best linear filter: sqrt(sum (s / sigma)^2) over all pixels, with
/// the expected light `s` of the object and the expected noise `sigma` of a pixel [e-].
double optimal_snr(const ExpectedElectronImage& light, const ElectronImage& noise);

/// Numbers of objects by pixel: 0 none, k the k-th, the brightest where masks overlap.
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
