#include "core/detector/blooming.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <vector>

#include "core/detector/detector.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

constexpr std::size_t column_grain = 16, row_grain = 64, pixel_grain = 16384;

// Moves `excess` (one value per row) along a column in one direction, filling pixels on the way.
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

// Distributes the charge above the well in one column; `excess` has room for each row.
void bloom_column(int x, float well, ElectronImage& electrons, std::vector<float>& excess,
                  FlagImage* flags) {
  const int rows = electrons.rows;
  const auto pixel = [&](int y) -> float& { return electrons.at(x, y); };
  std::vector<float> own(flags ? excess.size() : 0);  // charge of the pixel itself
  for (int y = 0; y < rows; ++y) {
    float& e = pixel(y);
    excess[std::size_t(y)] = 0.5f * std::max(0.0f, e - well);
    e = std::min(e, well);
    if (flags) own[std::size_t(y)] = e;
  }
  run(rows, 1, well, excess, pixel);
  run(rows, -1, well, excess, pixel);
  for (int y = 0; flags && y < rows; ++y)
    if (pixel(y) > own[std::size_t(y)]) flags->at(x, y) |= flag_bloomed;
}

// Columns in which a pixel is above the well.
std::vector<std::size_t> overfull_columns(float well, const ElectronImage& electrons,
                                          Threads& threads) {
  const auto columns = std::size_t(electrons.columns);
  std::vector<float> most(columns, 0.0f);
  std::mutex merging;
  threads.for_ranges(std::size_t(electrons.rows), row_grain,
                     [&](std::size_t begin, std::size_t end) {
                       std::vector<float> here(columns, 0.0f);
                       for (std::size_t y = begin; y < end; ++y) {
                         const float* row = electrons.row(int(y));
                         for (std::size_t x = 0; x < columns; ++x)
                           here[x] = row[x] > here[x] ? row[x] : here[x];
                       }
                       std::lock_guard lock(merging);
                       for (std::size_t x = 0; x < columns; ++x)
                         most[x] = std::max(most[x], here[x]);
                     });
  std::vector<std::size_t> found;
  for (std::size_t x = 0; x < columns; ++x)
    if (most[x] > well) found.push_back(x);
  return found;
}

}  // namespace

double Blooming::cost_s(int level, const PlanFacts& f) { return level * 1e-9 * f.pixels(); }

std::span<const ParameterOf<Blooming>> Blooming::parameters() {
  static constexpr ParameterOf<Blooming> table[] = {
      {"blooming", "BLOOMING", "charge above the full well runs along columns",
       &Blooming::blooming}};
  return table;
}

// Without a full well nothing overflows.
bool Blooming::applies(const Detector& detector) const {
  return blooming && detector.well_is_limited;
}

void Blooming::apply(const ExposureFacts& exposed, const WholeImage& image) const {
  image.saturated.full_well +=
      bloom(exposed.detector.full_well_e, image.electrons, image.threads, image.flags);
}

std::size_t bloom(double full_well_e, ElectronImage& electrons, Threads& threads,
                  FlagImage* flags) {
  const auto well = float(full_well_e);
  const auto overfull = overfull_columns(well, electrons, threads);
  threads.for_ranges(overfull.size(), column_grain, [&](std::size_t begin, std::size_t end) {
    std::vector<float> excess(static_cast<std::size_t>(electrons.rows));
    for (std::size_t i = begin; i < end; ++i)
      bloom_column(int(overfull[i]), well, electrons, excess, flags);
  });
  std::atomic<std::size_t> full{0};
  threads.for_ranges(electrons.pixels.size(), pixel_grain, [&](std::size_t begin, std::size_t end) {
    std::size_t here = 0;
    for (std::size_t i = begin; i < end; ++i) here += electrons.pixels[i] >= well;
    full += here;
    for (std::size_t i = begin; flags && here > 0 && i < end; ++i)
      if (electrons.pixels[i] >= well) flags->pixels[i] |= flag_full_well;
  });
  return full;
}

}  // namespace dmise
