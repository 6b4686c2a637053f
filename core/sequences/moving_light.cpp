#include "core/sequences/moving_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace dmise {
namespace {

constexpr int cell_px = 64;     // over which the map between two frames is linear
constexpr int segment_px = 16;  // part of a row over which it is a shift
constexpr double clip_sigmas = 3.0, light_error = 0.1;
constexpr std::size_t min_others = 3;
// The sky of a frame is that of others before and after a gap of a fifth of the sequence.
constexpr std::size_t min_frames_for_gap = 8, frames_of_gap = 5;

/// Part of a frame.
struct Cell {
  int x0, y0, x1, y1;  // before x1, y1
  PixelPosition middle() const { return {(x0 + x1 - 1) / 2.0, (y0 + y1 - 1) / 2.0}; }
};

std::vector<Cell> cells_of(int columns, int rows) {
  std::vector<Cell> cells;
  for (int y = 0; y < rows; y += cell_px)
    for (int x = 0; x < columns; x += cell_px)
      cells.push_back({x, y, std::min(x + cell_px, columns), std::min(y + cell_px, rows)});
  return cells;
}

/// Values of a frame at another frame's pixels, from `x0` on in a row; NaN outside.
void sample_segment(const PointAmplitude& from, PixelPosition first, int count, float scale,
                    float* to) {
  const double fx = std::floor(first.x_px), fy = std::floor(first.y_px);
  std::fill_n(to, count, std::numeric_limits<float>::quiet_NaN());
  if (!(fx >= 1 && fy >= 1 && fx + count + 1 < from.columns && fy + 2 < from.rows)) return;
  const auto wx = cubic_weights(first.x_px - fx), wy = cubic_weights(first.y_px - fy);
  std::fill_n(to, count, 0.0F);
  for (int v = 0; v < 4; ++v) {
    const float* row = from.row(int(fy) - 1 + v) + int(fx) - 1;
    for (int u = 0; u < 4; ++u) {
      const float w = scale * wx[std::size_t(u)] * wy[std::size_t(v)];
      for (int x = 0; x < count; ++x) to[x] += w * row[u + x];
    }
  }
}

/// Values of another frame at the pixels of a cell, by rows of `cell_px`.
void sample_cell(const PointAmplitude& from, const LinearMap& map, const Cell& cell, float scale,
                 float* to) {
  for (int y = cell.y0; y < cell.y1; ++y)
    for (int x = cell.x0; x < cell.x1; x += segment_px) {
      const int count = std::min(segment_px, cell.x1 - x);
      const double half = (count - 1) / 2.0;
      const PixelPosition first = map({x + half, double(y)}) - PixelPosition{half, 0};
      sample_segment(from, first, count, scale, to + (y - cell.y0) * cell_px + (x - cell.x0));
    }
}

struct SkyValue {
  float mean;
  std::size_t count;
};

/// Mean of values without those that stand out from their median; sorts the values.
SkyValue steady_mean(float* values, std::size_t count, double noise) {
  std::sort(values, values + count);
  const double median = (double(values[(count - 1) / 2]) + double(values[count / 2])) / 2;
  const double reach = clip_sigmas * std::hypot(noise, light_error * median);
  double sum = 0.0;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < count; ++k)
    if (std::abs(double(values[k]) - median) <= reach) {
      sum += double(values[k]);
      ++kept;
    }
  if (kept == 0) return {float(median), 1};
  return {float(sum / double(kept)), kept};
}

/// Share of a mean that is subtracted, by its SNR: where the sky shows no light, nothing, so that
/// neither its noise nor a slow object's own light is.
double shown_share(double snr) {
  constexpr double none = 2.0, all = 4.0;
  if (std::abs(snr) >= all) return 1.0;
  return std::max(std::abs(snr) - none, 0.0) * all / (all - none) / std::max(std::abs(snr), none);
}

/// How differences scatter at places of a starlight: a bin each for twice as much.
class NoiseByStarlight {
 public:
  static constexpr std::size_t bins = 14;

  /// `starlight`, `difference`: in units of the sky's noise.
  void add(double starlight, double difference) {
    const auto step = std::min(std::size_t(std::abs(difference) / step_size), steps - 1);
    ++counts_[bin_of(starlight)][step];
  }
  void add(const NoiseByStarlight& other) {
    for (std::size_t b = 0; b < bins; ++b)
      for (std::size_t s = 0; s < steps; ++s) counts_[b][s] += other.counts_[b][s];
  }
  static std::size_t bin_of(double starlight) {
    if (!(starlight >= 0.5)) return 0;
    return std::min(std::size_t(1 + std::log2(starlight / 0.5)), bins - 1);
  }
  /// Standard deviations; by the tails where stars shine, which are longer than a normal
  /// distribution's.
  std::array<double, bins> sigmas() const {
    std::array<double, bins> out{};
    for (std::size_t b = 0; b < bins; ++b) {
      const double before = b > 0 ? out[b - 1] : 0.2;
      const double measured = b < 3 ? quantile(b, 0.6827) : quantile(b, 0.9545) / 2;
      out[b] = total(b) < min_pixels ? (b > 0 ? 2 * before : 1.0) : std::max(measured, before);
    }
    return out;
  }

 private:
  static constexpr std::size_t steps = 2000;
  static constexpr double step_size = 0.02;
  static constexpr std::uint64_t min_pixels = 200;

  std::uint64_t total(std::size_t bin) const {
    std::uint64_t sum = 0;
    for (const auto c : counts_[bin]) sum += c;
    return sum;
  }
  double quantile(std::size_t bin, double share) const {
    const double wanted = share * double(total(bin));
    double sum = 0.0;
    for (std::size_t s = 0; s < steps; ++s) {
      const auto here = double(counts_[bin][s]);
      if (here > 0 && sum + here >= wanted) return (double(s) + (wanted - sum) / here) * step_size;
      sum += here;
    }
    return double(steps) * step_size;
  }

  std::vector<std::array<std::uint64_t, steps>> counts_ =
      std::vector<std::array<std::uint64_t, steps>>(bins);
};

/// Differences and starlight of a frame, both in units of its sky's noise.
class SkySubtraction {
 public:
  SkySubtraction(const FilteredSequence& sequence, const Registration& registration,
                 std::size_t frame, MovingLight& out)
      : sequence_(sequence), registration_(registration), frame_(frame), out_(out) {}

  /// Writes difference over noise to `snr`, and the factor of the noise by the number of other
  /// frames to `weight`, with the starlight in `starlight`.
  void subtract(const Cell& cell, MovingSnr& starlight, NoiseByStarlight& noise) const {
    const std::vector<float> others = samples(cell);
    const FilteredLight& frame = sequence_.frames[frame_];
    std::array<float, cell_px> noise_e{};
    std::vector<float> values(sequence_.frames.size());
    for (int y = cell.y0; y < cell.y1; ++y) {
      frame.noise_row(y, cell.x0, cell.x1, noise_e.data());
      for (int x = cell.x0; x < cell.x1; ++x) {
        const std::size_t at = std::size_t(y - cell.y0) * cell_px + std::size_t(x - cell.x0);
        const auto sigma = double(noise_e[std::size_t(x - cell.x0)]);
        const std::size_t count = known(others, at, values);
        const float here = frame.light.at(x, y);
        if (count == 0 || std::isnan(here)) continue;
        const SkyValue sky = steady_mean(values.data(), count, sigma);
        const double error = 1 / std::sqrt(double(sky.count));
        const double share = shown_share(double(sky.mean) / (sigma * error));
        const double known_here = frame.known.at(x, y) / 255.0;
        const double factor = std::hypot(1 / std::sqrt(known_here), share * error);
        out_.snr.at(x, y) = float((double(here) - share * double(sky.mean)) / (sigma * factor));
        out_.weight.at(x, y) = float(registration_.transmission(frame_) / (sigma * factor));
        starlight.at(x, y) = float(double(sky.mean) / sigma);
        noise.add(double(starlight.at(x, y)), double(out_.snr.at(x, y)));
      }
    }
  }

 private:
  /// Light of all other frames at the pixels of a cell, frame by frame.
  std::vector<float> samples(const Cell& cell) const {
    const std::size_t n = sequence_.frames.size();
    std::vector<float> out(n * cell_px * cell_px, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t j = 0; j < n; ++j)
      if (j != frame_)
        sample_cell(sequence_.frames[j].light,
                    registration_.around(frame_, j, cell.middle(), cell_px / 2.0), cell,
                    float(registration_.transmission(frame_) / registration_.transmission(j)),
                    out.data() + j * cell_px * cell_px);
    return out;
  }
  /// Whether a frame is taken for the sky: not soon before or after, when a slow object is still
  /// at its place.
  bool shows_sky(std::size_t other) const {
    const std::size_t apart = other > frame_ ? other - frame_ : frame_ - other;
    const std::size_t n = sequence_.frames.size();
    return apart > (n < min_frames_for_gap ? 0 : n / frames_of_gap);
  }
  /// Collects what other frames show at a pixel: those before and after the gap, or any if these
  /// are too few.
  std::size_t known(const std::vector<float>& samples, std::size_t at,
                    std::vector<float>& values) const {
    for (const bool any : {false, true}) {
      std::size_t count = 0;
      for (std::size_t j = 0; j < values.size(); ++j)
        if (const float v = samples[j * cell_px * cell_px + at];
            !std::isnan(v) && (any || shows_sky(j)))
          values[count++] = v;
      if (count >= (any ? 1 : min_others)) return count;
    }
    return 0;
  }

  const FilteredSequence& sequence_;
  const Registration& registration_;
  std::size_t frame_;
  MovingLight& out_;
};

/// Divides SNR and weights by the scatter that was measured at places of the same starlight.
void scale(const std::array<double, NoiseByStarlight::bins>& sigmas, const MovingSnr& starlight,
           MovingLight& light) {
  for (std::size_t p = 0; p < light.snr.pixels.size(); ++p) {
    const double sigma = sigmas[NoiseByStarlight::bin_of(double(starlight.pixels[p]))];
    light.snr.pixels[p] /= float(sigma);
    light.weight.pixels[p] /= float(sigma);
  }
}

}  // namespace

std::array<float, 4> cubic_weights(double t) {
  const double t2 = t * t, t3 = t2 * t;
  return {float(-0.5 * t + t2 - 0.5 * t3), float(1 - 2.5 * t2 + 1.5 * t3),
          float(0.5 * t + 2 * t2 - 1.5 * t3), float(-0.5 * t2 + 0.5 * t3)};
}

std::array<float, 4> cubic_slopes(double t) {
  const double t2 = t * t;
  return {float(-0.5 + 2 * t - 1.5 * t2), float(-5 * t + 4.5 * t2), float(0.5 + 4 * t - 4.5 * t2),
          float(-t + 1.5 * t2)};
}

std::vector<MovingLight> moving_light(const FilteredSequence& sequence,
                                      const Registration& registration, Threads& threads) {
  const int columns = sequence.columns, rows = sequence.rows;
  const std::vector<Cell> cells = cells_of(columns, rows);
  std::vector<MovingLight> out;
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    out.push_back({MovingSnr(columns, rows), PointWeight(columns, rows)});
    MovingLight& light = out.back();
    MovingSnr starlight(columns, rows);
    const SkySubtraction subtraction(sequence, registration, i, light);
    constexpr std::size_t grain = 64;
    std::vector<NoiseByStarlight> parts((cells.size() + grain - 1) / grain);
    threads.for_ranges(cells.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c)
        subtraction.subtract(cells[c], starlight, parts[begin / grain]);
    });
    for (std::size_t p = 1; p < parts.size(); ++p) parts[0].add(parts[p]);
    scale(parts[0].sigmas(), starlight, light);
  }
  return out;
}

}  // namespace dmise
