#include "core/dataset/object_mask.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace dmise {

ObjectMask mask_of(const ExpectedElectronImage& light, double share) {
  ObjectMask mask{.columns = light.columns, .rows = light.rows};
  for (const float e : light.pixels) mask.all_e += double(e);
  if (!(mask.all_e > 0.0)) return mask;
  // Pixels below this hold less than 1 - share together.
  const double min_e = (1.0 - share) * mask.all_e / double(light.pixels.size());
  for (std::uint32_t i = 0; i < light.pixels.size(); ++i)
    if (double(light.pixels[i]) > min_e) mask.pixels.push_back(i);
  std::sort(mask.pixels.begin(), mask.pixels.end(), [&](std::uint32_t a, std::uint32_t b) {
    return light.pixels[a] != light.pixels[b] ? light.pixels[a] > light.pixels[b] : a < b;
  });
  std::size_t count = 0;
  while (count < mask.pixels.size() && mask.covered_e < share * mask.all_e)
    mask.covered_e += double(light.pixels[mask.pixels[count++]]);
  mask.pixels.resize(count);
  std::sort(mask.pixels.begin(), mask.pixels.end());
  mask.left = mask.columns;
  mask.top = mask.rows;
  for (const std::uint32_t i : mask.pixels) {
    const int x = int(i) % mask.columns, y = int(i) / mask.columns;
    mask.left = std::min(mask.left, x);
    mask.right = std::max(mask.right, x + 1);
    mask.top = std::min(mask.top, y);
    mask.bottom = std::max(mask.bottom, y + 1);
  }
  return mask;
}

std::string coco_counts(const ObjectMask& mask) {
  const auto columns = std::uint32_t(mask.columns), rows = std::uint32_t(mask.rows);
  std::vector<std::uint32_t> places;  // down the columns
  for (const std::uint32_t i : mask.pixels) places.push_back(i % columns * rows + i / columns);
  std::sort(places.begin(), places.end());
  std::vector<std::int64_t> runs;
  std::uint32_t next = 0;  // the first place that is not in a run
  for (std::size_t k = 0; k < places.size();) {
    std::size_t end = k + 1;
    while (end < places.size() && places[end] == places[end - 1] + 1) ++end;
    runs.push_back(places[k] - next);
    runs.push_back(std::int64_t(end - k));
    next = places[end - 1] + 1;
    k = end;
  }
  if (next < columns * rows || runs.empty()) runs.push_back(columns * rows - next);
  std::string text;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    std::int64_t x = k > 2 ? runs[k] - runs[k - 2] : runs[k];
    for (bool more = true; more;) {
      const std::int64_t bits = x & 0x1f;
      x >>= 5;
      more = bits & 0x10 ? x != -1 : x != 0;
      text += char(48 + (bits | (more ? 0x20 : 0)));
    }
  }
  return text;
}

double optimal_snr(const ExpectedElectronImage& light, const ElectronImage& noise) {
  double sum = 0.0;
  for (std::size_t i = 0; i < light.pixels.size(); ++i) {
    if (!(light.pixels[i] > 0.0f) || !(noise.pixels[i] > 0.0f)) continue;
    const double ratio = double(light.pixels[i]) / double(noise.pixels[i]);
    sum += ratio * ratio;
  }
  return std::sqrt(sum);
}

LabelPlane::LabelPlane(int columns, int rows) : labels_(columns, rows), brightest_(columns, rows) {}

void LabelPlane::add(std::size_t label, const ObjectMask& mask,
                     const ExpectedElectronImage& light) {
  if (label > 65535) throw Error("a frame has more than 65535 objects, which labels can't number");
  for (const std::uint32_t i : mask.pixels)
    if (labels_.pixels[i] == 0 || light.pixels[i] > brightest_.pixels[i]) {
      labels_.pixels[i] = std::uint16_t(label);
      brightest_.pixels[i] = light.pixels[i];
    }
}

}  // namespace dmise
