#include "core/detector/blooming.h"

#include <algorithm>
#include <atomic>
#include <vector>

namespace dmise {
namespace {

constexpr std::size_t column_grain = 64;

// Moves `excess` (one value a row) along a column in one direction, and fills it up on the way.
template <class Pixel>
void run(int rows, int step, float well, const std::vector<float>& excess, const Pixel& pixel) {
  double carried = 0.0;
  for (int y = step > 0 ? 0 : rows - 1; y >= 0 && y < rows; y += step) {
    float& e = pixel(y);
    const double taken = std::min(carried, double(well) - e);
    if (taken > 0.0) {
      e = carried >= double(well) - e ? well : float(e + taken);
      carried -= taken;
    }
    carried += excess[std::size_t(y)];
  }
}

}  // namespace

std::size_t blooming(double full_well_e, ElectronImage& electrons, Threads& threads,
                     FlagImage* flags) {
  const auto well = float(full_well_e);
  const int rows = electrons.rows;
  std::atomic<std::size_t> full{0};
  threads.for_ranges(
      std::size_t(electrons.columns), column_grain, [&](std::size_t begin, std::size_t end) {
        std::vector<float> excess(electrons.pixels.size() / std::size_t(electrons.columns));
        std::vector<float> own(flags ? excess.size() : 0);  // what a pixel holds of its own
        std::size_t here = 0;
        for (std::size_t x = begin; x < end; ++x) {
          const auto pixel = [&](int y) -> float& { return electrons.at(int(x), y); };
          bool any = false;
          for (int y = 0; y < rows; ++y) {
            float& e = pixel(y);
            const float above = std::max(0.0f, e - well);
            excess[std::size_t(y)] = 0.5f * above;
            any = any || above > 0.0f;
            e = std::min(e, well);
            if (flags) own[std::size_t(y)] = e;
          }
          if (any) {
            run(rows, 1, well, excess, pixel);
            run(rows, -1, well, excess, pixel);
          }
          for (int y = 0; y < rows; ++y) here += pixel(y) >= well;
          for (int y = 0; flags && y < rows; ++y) {
            if (pixel(y) >= well) flags->at(int(x), y) |= flag_full_well;
            if (pixel(y) > own[std::size_t(y)]) flags->at(int(x), y) |= flag_bloomed;
          }
        }
        full += here;
      });
  return full;
}

}  // namespace dmise
