#include "core/detector/frame_transfer.h"

#include "core/detector/detector.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

constexpr std::size_t rows_a_sum = 16;

}  // namespace

double FrameTransfer::cost_s(int level, const PlanFacts& f) { return level * 1.5e-9 * f.pixels(); }

std::span<const ParameterOf<FrameTransfer>> FrameTransfer::parameters() {
  static constexpr ParameterOf<FrameTransfer> table[] = {
      {"frame_transfer_s", "FTRANSF", "[s] shift of the image under the mask",
       &FrameTransfer::frame_transfer_s, 0.0, 100.0}};
  return table;
}

FrameTransfer::Prepared FrameTransfer::sums_of(const ExpectedElectronImage& light) const {
  const auto columns = std::size_t(light.columns);
  std::vector<double> passed(columns);
  Prepared sums;
  for (std::size_t y = 0; y < std::size_t(light.rows); ++y) {
    if (y % rows_a_sum == 0) sums.insert(sums.end(), passed.begin(), passed.end());
    const float* row = light.row(int(y));
    for (std::size_t x = 0; x < columns; ++x) passed[x] += row[x];
  }
  return sums;
}

void FrameTransfer::add(const ExpectedElectronImage& light, const Exposure& exposure,
                        const Prepared& sums, std::size_t first, std::span<float> electrons) const {
  if (!(exposure.exposure_s > 0.0)) return;
  const auto columns = std::size_t(light.columns);
  const double share = frame_transfer_s / (double(light.rows) * exposure.exposure_s);
  const std::size_t end = first + electrons.size();
  const std::size_t block = first / columns / rows_a_sum;
  for (std::size_t x = 0; x < columns; ++x) {
    double passed = sums[block * columns + x];
    for (std::size_t i = block * rows_a_sum * columns + x; i < end; i += columns) {
      if (i >= first) electrons[i - first] += float(share * passed);
      passed += light.pixels[i];
    }
  }
}

void FrameTransfer::apply(const ExposureFacts& exposed, const Prepared& sums, Piece& piece) const {
  add(exposed.light, exposed.exposure, sums, piece.first, piece.electrons);
}

ExpectedElectronImage FrameTransfer::smeared(const ExpectedElectronImage& light,
                                             const Exposure& exposure) const {
  ExpectedElectronImage result = light;
  add(light, exposure, sums_of(light), 0, result.pixels);
  return result;
}

}  // namespace dmise
