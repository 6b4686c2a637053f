#include "core/detector/charge_transfer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/detector/detector.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

constexpr std::size_t transfer_columns = 64, transfer_rows = 64;

/// All transfers of a line of pixels in a few steps of a share of them each, in which what traps
/// release is not trapped again: with N transfers and an inefficiency c, a share of (N c)^2 / (2
/// steps) of the charge is a trail too near.
class Transfers {
 public:
  Transfers(double inefficiency, double release_px, int length)
      : length_(length),
        steps_(1 + int(std::ceil(std::min(32.0, 20.0 * inefficiency * length)))),
        stay_(release_px > 0.0 ? std::exp(-1.0 / release_px) : 0.0) {
    lost_.reserve(std::size_t(length));
    for (int i = 0; i < length; ++i)
      lost_.push_back(-std::expm1((i + 1.0) / steps_ * std::log1p(-inefficiency)));
  }

  /// Moves `lines` lines together: pixel i of line k is pixels[i stride + k next].
  void apply(float* pixels, std::size_t stride, std::size_t lines, std::size_t next) const {
    std::vector<double> trapped(lines);
    for (int step = 0; step < steps_; ++step) {
      std::fill(trapped.begin(), trapped.end(), 0.0);
      for (int i = 0; i < length_; ++i) {
        float* at = pixels + std::size_t(i) * stride;
        const double lost = lost_[std::size_t(i)];
        for (std::size_t k = 0; k < lines; ++k) {
          float& e = at[k * next];
          const double taken = lost * e, freed = (1.0 - stay_) * trapped[k];
          e = float(e - taken + freed);
          trapped[k] = trapped[k] - freed + taken;
        }
      }
    }
  }

 private:
  int length_, steps_;
  double stay_;  // share of what is trapped that a transfer leaves there
  std::vector<double> lost_;
};

}  // namespace

double ChargeTransfer::cost_s(int level, const PlanFacts& f) { return level * 6e-9 * f.pixels(); }

std::span<const ParameterOf<ChargeTransfer>> ChargeTransfer::parameters() {
  static constexpr ParameterOf<ChargeTransfer> table[] = {
      {"parallel_cti", "CTIPAR", "charge left behind a transfer along columns",
       &ChargeTransfer::parallel_cti, 0.0, 0.01},
      {"serial_cti", "CTISER", "charge left behind a transfer along rows",
       &ChargeTransfer::serial_cti, 0.0, 0.01},
      {"cti_release_px", "CTIREL", "[transfers] until traps release it, exponential",
       &ChargeTransfer::cti_release_px, 0.0, 1e4}};
  return table;
}

void ChargeTransfer::apply(const ExposureFacts&, const WholeImage& image) const {
  ElectronImage& e = image.electrons;
  const auto columns = std::size_t(e.columns), rows = std::size_t(e.rows);
  if (parallel_cti > 0.0) {
    const Transfers transfers(parallel_cti, cti_release_px, e.rows);
    const std::size_t blocks = (columns + transfer_columns - 1) / transfer_columns;
    image.threads.for_ranges(blocks, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t x = begin * transfer_columns; x < std::min(end * transfer_columns, columns);
           x += transfer_columns)
        transfers.apply(e.pixels.data() + x, columns, std::min(transfer_columns, columns - x), 1);
    });
  }
  if (serial_cti > 0.0) {
    const Transfers transfers(serial_cti, cti_release_px, e.columns);
    image.threads.for_ranges(rows, transfer_rows, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; y += 8)
        transfers.apply(e.row(int(y)), 1, std::min<std::size_t>(8, end - y), columns);
    });
  }
}

}  // namespace dmise
