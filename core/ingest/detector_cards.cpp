#include "core/ingest/detector_cards.h"

#include <algorithm>
#include <cmath>

#include "core/base/algebra/two_unknowns.h"
#include "core/base/formatted.h"
#include "core/base/numeric/quantile.h"
#include "core/detection/pixels/background.h"

namespace dmise {
namespace {

constexpr double max_gain = 20.0;    // a larger GAIN [e-/count] is a camera's setting
constexpr double min_noise_e = 0.1;  // no camera has less
constexpr int mesh_px = 64;

/// Electrons per count by the noise of the sky: the slope of variance against level over a mesh.
struct MeasuredGain {
  double e_per_dn = 0.0, sigma = 0.0;
};

/// Empty where levels span too little: the slope must be known to 10 %. Frames whose pixels were
/// averaged or resampled have less noise than light, and so too high a gain.
std::optional<MeasuredGain> measure_gain(const CountImage& counts, const Background& background,
                                         int cell_px = mesh_px) {
  struct Cell {
    double level, variance;
  };
  std::vector<Cell> cells;
  for (int y = cell_px / 2; y < counts.rows; y += cell_px)
    for (int x = cell_px / 2; x < counts.columns; x += cell_px) {
      const double sigma = background.sigma_dn(x, y), level = background.level_dn(x, y);
      if (sigma > 0.5) cells.push_back({level, sigma * sigma - 1.0 / 12});
    }
  if (cells.size() < 50) return std::nullopt;
  // A cell's variance scatters with its square; a cell with stars is an outlier above.
  double slope = 0.0, slope_sigma = 0.0;
  std::vector<char> used(cells.size(), 1);
  for (int pass = 0; pass < 6; ++pass) {
    TwoSums sums{};
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (const auto& [level, variance] = cells[i]; used[i])
        add_row(1.0, level, variance, 1 / (variance * variance), sums);
    const double det = determinant(matrix_of(sums));
    if (!(det > 1e-9 * sums[0] * sums[2])) return std::nullopt;
    const auto [offset, slope_now] = solution_of(sums);
    slope = slope_now;
    std::vector<double> off;
    for (std::size_t i = 0; i < cells.size(); ++i)
      off.push_back(std::abs(cells[i].variance - offset - slope * cells[i].level) /
                    cells[i].variance);
    const double scatter = std::max(sigma_of_median * median_of(off), 1e-6);
    slope_sigma = scatter * std::sqrt(sums[0] / det);
    for (std::size_t i = 0; i < cells.size(); ++i) used[i] = off[i] < 3 * scatter;
  }
  if (!(slope > 10 * slope_sigma) || !(slope_sigma > 0)) return std::nullopt;
  const double gain = 1 / slope;
  return MeasuredGain{gain, gain * slope_sigma / slope};
}

/// Measures with the pixels of each kind alone, in electrons per count of the evened image.
std::optional<MeasuredGain> measure_gain_of(const ColourMosaic& mosaic, const CountMap& map,
                                            Threads& threads) {
  constexpr int cell_px = mesh_px / 2;
  double weights = 0.0, sum = 0.0;
  for (const CountImage& kind : mosaic.kinds()) {
    const auto one = measure_gain(kind, Background(kind, cell_px, threads), cell_px);
    if (!one) continue;
    const double weight = 1 / (one->sigma * one->sigma);
    weights += weight;
    sum += weight * one->e_per_dn;
  }
  if (!(weights > 0)) return std::nullopt;
  const double steps = map.step / mosaic.map().step;
  return MeasuredGain{sum / weights * steps, steps / std::sqrt(weights)};
}

/// A gain by which the sky's noise is one that a camera can have.
std::optional<StandardCards::Named<double>> stated_gain(const StandardCards& cards, double noise) {
  for (const auto& [key, most] : {std::pair{"EGAIN", 1e9}, {"GAIN", max_gain}}) {
    const auto gain = cards.number(key);
    if (!gain) continue;
    if (!(*gain > 0 && *gain <= most))
      cards.reject(key, "gain: is not in electrons per count");
    else if (*gain * noise < min_noise_e)
      cards.reject(key, "gain: makes the sky's noise less than 0.1 electrons");
    else
      return StandardCards::Named<double>{key, *gain};
  }
  return std::nullopt;
}

/// Whether a gain is a camera's setting: light of so many electrons a count had less noise. Pixels
/// that were averaged or resampled have less noise than their light, never more.
bool is_setting(const StandardCards::Named<double>& stated, const MeasuredGain& measured) {
  constexpr double min_ratio = 1.5, min_sigmas = 5.0;
  return stated.key == "GAIN" && stated.value > min_ratio * measured.e_per_dn &&
         stated.value - measured.e_per_dn > min_sigmas * measured.sigma;
}

void set_gain(const StandardCards& cards, const CountSource& source, const CountImage& counts,
              const Background& background, Threads& threads, FrameHeader& header) {
  const CountMap& map = source.map;
  const auto measured = [&]() -> std::optional<MeasuredGain> {
    auto gain = source.mosaic ? measure_gain_of(*source.mosaic, map, threads)
                              : measure_gain(counts, background);
    if (gain) gain->e_per_dn /= map.step, gain->sigma /= map.step;
    return gain;
  };
  const auto stated = stated_gain(cards, background.median_sigma_dn() * map.step);
  if (stated && stated->key == "EGAIN") {
    header.gain_e_per_dn = stated->value * map.step;
    return;
  }
  const auto gain = measured();
  if (stated && !(gain && is_setting(*stated, *gain))) {
    header.gain_e_per_dn = stated->value * map.step;
    cards.assumed(formatted("gain: GAIN = %.6g is taken for electrons per count", stated->value));
    return;
  }
  if (gain) {
    if (stated) cards.reject("GAIN", "gain: light of so many electrons a count had less noise");
    header.gain_e_per_dn = gain->e_per_dn * map.step;
    cards.assumed(formatted("gain: %.4g +- %.2g electrons per count, measured from the sky's noise",
                            gain->e_per_dn, gain->sigma));
    return;
  }
  header.gain_e_per_dn = 1.0;
  header.unknown.add(FrameFact::gain);
  cards.missing(map.step == 1.0
                    ? "gain: no EGAIN or GAIN: electrons are counts"
                    : formatted("gain: no EGAIN or GAIN: electrons are steps of %.4g", map.step));
}

/// `planes` were added.
void set_bias(const StandardCards& cards, const CountMap& map, int planes, FrameHeader& header) {
  std::optional<double> bias = cards.number("BIASLVL");
  if (const auto pedestal = cards.number("PEDESTAL"); !bias && pedestal) {
    bias = std::abs(*pedestal);  // both signs are in use
    cards.assumed("bias: the size of PEDESTAL");
  }
  header.bias_dn = map.count(planes * bias.value_or(0.0));
  if (bias) return;
  header.unknown.add(FrameFact::bias);
  cards.missing("bias: no BIASLVL or PEDESTAL");
}

void set_read_noise(const StandardCards& cards, double noise_dn, int planes, FrameHeader& header) {
  const auto stated = cards.first_number({"RDNOISE", "READNOIS", "ENOISE"});
  if (stated && stated->value >= 0 && stated->value < 1e5 && !header.unknown.has(FrameFact::gain)) {
    header.read_noise_e = stated->value * std::sqrt(double(planes));
    return;
  }
  header.read_noise_e = noise_dn * header.gain_e_per_dn;
  cards.assumed("read noise: that of the sky, which is more");
}

/// A single one of added planes may be clipped: the sum is then at least its limit and the bias of
/// the others.
void set_saturation(const StandardCards& cards, const CountSource& source, double sky_dn,
                    FrameHeader& header) {
  constexpr double highest = 65535.0;
  const CountMap& map = source.map;
  header.saturation_dn = highest;
  const auto count_of = [&](double value) {
    return map.count(source.mosaic ? source.mosaic->min_evened(value) : value);
  };
  if (const auto stated = cards.first_number({"SATURATE", "SATLEVEL"})) {
    const double bias = header.bias_dn - map.count(0.0), planes = source.planes;
    const double limit = count_of(stated->value) + bias * (planes - 1) / planes;
    if (limit > sky_dn) {
      header.saturation_dn = std::min(highest, limit);
      return;
    }
    cards.reject(stated->key, "saturation: is less than the sky");
  }
  const Ceiling top = find_ceiling(source.values);
  if (top.pixels == 0) {
    cards.missing("saturation: no SATURATE, and no greatest value that pixels share");
    return;
  }
  header.saturation_dn = std::min(highest, std::max(1.0, count_of(top.value)));
  cards.assumed(formatted("saturation: %.10g, the greatest value, which %.0f pixels have",
                          top.value, double(top.pixels)));
}

}  // namespace

void set_detector(const StandardCards& cards, const CountSource& source, const CountImage& counts,
                  Threads& threads, FrameHeader& header) {
  const CountMap& map = source.map;
  const Background background(counts, mesh_px, threads);
  set_gain(cards, source, counts, background, threads, header);
  set_bias(cards, map, source.planes, header);
  set_read_noise(cards, background.median_sigma_dn(), source.planes, header);
  set_saturation(cards, source, background.median_level_dn(), header);
  if (!map.is_identity())
    cards.assumed(
        formatted("pixels: mapped to 16 bits in steps of %.4g from %.6g on", map.step, map.zero));
}

}  // namespace dmise
