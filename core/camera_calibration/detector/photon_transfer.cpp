#include "core/camera_calibration/detector/photon_transfer.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/algebra/two_unknowns.h"
#include "core/base/numeric/chi_square.h"

namespace dmise {
namespace {

constexpr double full_share = 0.3;  // full tiles have less of the noise that their light would have

/// The noise of light per signal of each pair, 1 / gain in DN; tiles without light do not count.
double noise_per_signal(const FlatPair& pair, double floor_variance) {
  double variance = 0.0, signal = 0.0;
  for (const PairTile& tile : pair.tiles) {
    if (!(tile.pixels > 0)) continue;
    variance += double(tile.variance) - floor_variance;
    signal += double(tile.signal);
  }
  return signal > 0 ? variance / signal : 0.0;
}

TwoSums total_of_strips(const std::vector<TwoSums>& strips) {
  TwoSums all{};
  for (const TwoSums& strip : strips)
    for (std::size_t k = 0; k < all.size(); ++k) all[k] += strip[k];
  return all;
}

/// What a tile would show if the response were straight: its signal, and the noise of its light.
struct StraightTile {
  double signal = 0.0, light_variance = 0.0, slope = 1.0;
};

StraightTile straight(const PairTile& tile, double loss_per_dn, double floor_variance) {
  const double root = std::sqrt(std::max(0.0, 1 - 4 * loss_per_dn * double(tile.signal)));
  const double signal = 2 * double(tile.signal) / (1 + root);
  return {signal, (double(tile.variance) - floor_variance) / std::max(root * root, 0.01), root};
}

/// Steadiness of the lamp by the means of whole flats: the loss's deviation by it [1/DN].
double loss_by_lamp(const std::vector<std::array<double, 3>>& frames, double rate_dn_per_s,
                    Linearity& out) {
  // For each frame: its time, its mean over the fit's, and the variance of this ratio by noise.
  double chi2 = 0.0, squares = 0.0, n = 0.0, time = 0.0, times = 0.0;
  for (const auto& [t, ratio, variance] : frames) {
    chi2 += (ratio - 1) * (ratio - 1) / variance;
    squares += (ratio - 1) * (ratio - 1);
    time += t, times += t * t, ++n;
  }
  if (n < 4 || chi2 < chi_square_of_normal(3.1, n - 2)) return 0.0;
  out.unsteady = std::sqrt(squares / (n - 2));
  return out.unsteady / std::sqrt(times - time * time / n) / rate_dn_per_s;
}

double coupling_of_correlation(double correlation) {
  double coupling = correlation / 2;
  for (int i = 0; i < 20; ++i)
    coupling = correlation * share_of_own_noise(coupling) / (2 * (1 - 4 * std::min(coupling, 0.2)));
  return std::clamp(coupling, -0.2, 0.2);
}

}  // namespace

double share_of_own_noise(double coupling) {
  const double own = 1 - 4 * coupling;
  return own * own + 4 * coupling * coupling;
}

Saturation find_saturation(const FlatTiles& flats, const Tiles& tiles, double floor_variance) {
  Saturation out;
  out.usable.assign(flats.flats.size(), 1);
  // The noise per signal of the fainter half of the pairs.
  std::vector<double> slopes;
  double highest = 0.0;
  for (std::size_t f = 0; f < flats.flats.size(); ++f)
    highest = std::max(highest, flats.mean_of(f));
  for (const FlatPair& pair : flats.pairs)
    if (flats.mean_of(pair.first) <= 0.5 * highest)
      slopes.push_back(noise_per_signal(pair, floor_variance));
  if (slopes.empty())
    for (const FlatPair& pair : flats.pairs)
      slopes.push_back(noise_per_signal(pair, floor_variance));
  if (slopes.empty()) return out;
  // All flats may be full but for the faintest: the noise of full ones is less.
  const double slope = quantile_of(slopes, 0.75);
  std::vector<StripSums<2>> strips(std::size_t(tiles.strips));
  std::vector<float> full;
  for (const FlatPair& pair : flats.pairs)
    for (std::size_t t = 0; t < pair.tiles.size(); ++t) {
      const PairTile& tile = pair.tiles[t];
      const double light = slope * double(tile.signal);
      if (tile.pixels > 0 && double(tile.signal) > 0.3 * highest && light > floor_variance &&
          double(tile.variance) - floor_variance < full_share * light)
        full.push_back(tile.signal);
    }
  constexpr std::size_t least_full = 8;
  if (full.size() >= least_full) {
    // A tile that is full in part has less signal.
    const float level = quantile_of(full, 0.9);
    const double near = std::max(1.0, 3e-3 * double(level));
    for (const FlatPair& pair : flats.pairs)
      for (std::size_t t = 0; t < pair.tiles.size(); ++t) {
        const PairTile& tile = pair.tiles[t];
        if (!(tile.pixels > 0) || std::abs(double(tile.signal) - double(level)) > near ||
            double(tile.variance) > floor_variance + full_share * slope * double(tile.signal))
          continue;
        strips[tiles.strip_of(t)][0] += 1;
        strips[tiles.strip_of(t)][1] += double(tile.signal);
      }
    out.level = jackknifed(strips, mean_of_sums);
    if (!std::isfinite(out.level->sigma)) out.level->sigma = near;
  }
  for (std::size_t f = 0; f < flats.flats.size(); ++f) {
    double all = 0.0, held = 0.0;
    for (std::size_t t = 0; t < flats.tiles[f].size(); ++t)
      if (flats.tiles[f][t].mean > 0) ++all, held += out.holds(flats.tiles[f][t]);
    out.usable[f] = all > 0 && held > 0.99 * all;
    out.saturated += !out.usable[f];
  }
  return out;
}

Linearity measure_linearity(const FlatTiles& flats, const Tiles& tiles,
                            const Saturation& saturation, double floor_variance) {
  Linearity out;
  std::vector<std::size_t> used;
  std::set<double> times;
  for (std::size_t f = 0; f < flats.flats.size(); ++f)
    if (saturation.usable[f] && flats.flats[f]->exposure_s.value_or(0.0) > 0) {
      used.push_back(f);
      times.insert(*flats.flats[f]->exposure_s);
    }
  if (used.size() < 4 || times.size() < 3 || *times.rbegin() < 3 * *times.begin()) return out;
  // Fits each tile by S = p t + q t^2 with weights 1 / t: the loss is -q / p^2.
  std::vector<StripSums<2>> strips(std::size_t(tiles.strips));
  std::vector<double> model(used.size(), 0.0), mean(used.size(), 0.0);
  double rates = 0.0, count = 0.0;
  for (std::size_t t = 0; t < tiles.count(); ++t) {
    bool held = true;
    TwoSums fit{};
    for (const std::size_t f : used) {
      held = held && saturation.holds(flats.tiles[f][t]);
      const double time = *flats.flats[f]->exposure_s;
      add_row(time, time * time, double(flats.tiles[f][t].mean), 1 / time, fit);
    }
    if (!held) continue;
    const auto [p, q] = solution_of(fit);
    auto& s = strips[tiles.strip_of(t)];
    s[0] += p * p * p * p;
    s[1] -= q * p * p;
    rates += p, ++count;
    for (std::size_t i = 0; i < used.size(); ++i) {
      const double time = *flats.flats[used[i]]->exposure_s;
      model[i] += p * time + q * time * time;
      mean[i] += double(flats.tiles[used[i]][t].mean);
    }
  }
  if (!(count > 0)) return out;
  std::vector<std::array<double, 3>> frames;
  const double pixels = count * tiles.width * tiles.height;
  for (std::size_t i = 0; i < used.size(); ++i) {
    double scatter = 0.0, n = 0.0;  // by tiles, whose scatter holds more than the noise
    for (const FlatTile& tile : flats.tiles[used[i]])
      if (tile.mean > 0) scatter += double(tile.scatter) * double(tile.scatter), ++n;
    const double variance = std::max(scatter / n, floor_variance) / pixels;
    frames.push_back({*flats.flats[used[i]]->exposure_s, mean[i] / model[i],
                      variance / std::pow(mean[i] / count, 2)});
  }
  MeasuredValue loss = jackknifed(strips, mean_of_sums);
  const double by_lamp = loss_by_lamp(frames, rates / count, out);
  constexpr double max_unsteady = 0.01;
  out.frames = int(used.size());
  loss.sigma = std::hypot(loss.sigma, by_lamp);
  if (out.unsteady < max_unsteady) out.loss_per_dn = loss;
  return out;
}

PhotonTransfer measure_gain(const FlatTiles& flats, const Tiles& tiles,
                            const Saturation& saturation, const Linearity& linearity,
                            double floor_variance, bool mosaic) {
  PhotonTransfer out;
  const double loss = linearity.loss_per_dn ? linearity.loss_per_dn->value : 0.0;
  std::set<long> levels;  // in steps of 20 %
  out.lowest_dn = HUGE_VAL;
  double tiles_used = 0.0;
  for (const FlatPair& pair : flats.pairs) {
    const double signal = flats.mean_of(pair.first);
    double held = 0.0;
    for (const FlatTile& tile : flats.tiles[pair.first]) held += saturation.holds(tile);
    if (!(signal > 0) || !(held > 0)) continue;
    levels.insert(std::lround(std::log(signal) / 0.2));
    out.frames += 2;
    tiles_used += held;
    out.lowest_dn = std::min(out.lowest_dn, signal);
    out.highest_dn = std::max(out.highest_dn, signal);
  }
  if (!(tiles_used > 0)) return out;
  constexpr std::size_t levels_of_curvature = 4;
  const bool curved = levels.size() >= levels_of_curvature && out.highest_dn > 3 * out.lowest_dn;
  std::vector<TwoSums> strips, couplings;
  double slope = 0.0, curvature = 0.0;
  // Weights by the fit before, as measured variances would favour low ones.
  for (int round = 0; round < 4; ++round) {
    strips.assign(std::size_t(tiles.strips), {});
    couplings.assign(std::size_t(tiles.strips), {});
    for (const FlatPair& pair : flats.pairs)
      for (std::size_t t = 0; t < pair.tiles.size(); ++t) {
        const PairTile& tile = pair.tiles[t];
        if (!(tile.pixels > 0) || !saturation.holds(flats.tiles[pair.first][t]) ||
            !saturation.holds(flats.tiles[pair.second][t]))
          continue;
        const StraightTile s = straight(tile, loss, floor_variance);
        const double light = std::max(0.0, slope * s.signal + curvature * s.signal * s.signal);
        const double variance = round == 0 ? floor_variance + double(tile.variance)
                                           : floor_variance + light * s.slope * s.slope;
        const double weight =
            double(tile.pixels) * std::pow(s.slope, 4) / std::max(variance * variance, 1e-12);
        auto& sums = strips[tiles.strip_of(t)];
        add_row(s.signal, s.signal * s.signal, s.light_variance, weight, sums);
        const double own = light * s.slope * s.slope;
        add_row(own, own * s.signal, double(tile.covariance),
                double(tile.pixels) / (variance * variance), couplings[tiles.strip_of(t)]);
      }
    const auto [a, b] = solution_of(total_of_strips(strips), curved);
    slope = a, curvature = b;
    if (!(slope > 0)) return out;
  }
  MeasuredValue gain =
      jackknifed(strips, [&](const TwoSums& s) { return 1 / solution_of(s, curved)[0]; });
  if (!mosaic) {
    const MeasuredValue correlation =
        jackknifed(couplings, [&](const TwoSums& s) { return solution_of(s, curved)[0]; });
    out.coupling = {coupling_of_correlation(correlation.value), correlation.sigma / 2};
  }
  constexpr double coupling_sigmas = 5.0;
  if (out.coupling.is_significant(coupling_sigmas)) {
    // Coupled pixels have less noise: the gain is less by the share that they keep.
    const double share = share_of_own_noise(out.coupling.value);
    gain.value *= share;
    gain.sigma = std::hypot(gain.sigma * share, gain.value * 8 * out.coupling.sigma);
  }
  if (!curved && linearity.loss_per_dn)
    gain.sigma =
        std::hypot(gain.sigma, 3 * gain.value * out.highest_dn * linearity.loss_per_dn->sigma);
  out.shortfall_per_dn = -curvature / slope;
  out.gain_e_per_dn = gain;
  return out;
}

}  // namespace dmise
