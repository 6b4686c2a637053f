#include "core/detection/curve/streak_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/units.h"
#include "core/detection/source/source_fit.h"

namespace dmise {
namespace {

constexpr double min_fwhms = 4.0;        // shortest line that is measured
constexpr std::size_t max_pieces = 800;  // longer lines have longer pieces
constexpr double reach_sigmas = 5.0;     // along the line, of the light of a piece
constexpr double across_sigmas = 3.0, across_px = 1.0;
constexpr double least_seen = 0.3;  // share of the light of a bin that is measured
constexpr double weak = 1e-6;       // the prior's weight over the largest: keeps equations solvable
constexpr int passes = 3;           // each takes its weights from the light of the one before

/// A pixel and the light of pieces in it, of `first` and those behind it.
struct PiecePixel {
  FitPixel pixel;
  std::size_t first = 0;
  std::vector<double> share;
};

/// Piece `i` of the line as a trail with one electron.
Trail piece_of(const Trail& line, const StreakLight& light, std::size_t i) {
  const double along = light.along_px(i), half = line.length_px / 2, r = along / half;
  const double off = line.sagitta_px * (1.0 / 3 - r * r);
  Trail piece = line;
  const double c = std::cos(line.angle_rad), s = std::sin(line.angle_rad);
  piece.x_px += along * c - off * s;
  piece.y_px += along * s + off * c;
  piece.angle_rad += std::atan(-2 * line.sagitta_px * r / half);
  piece.flux_e = 1.0;
  piece.length_px = light.piece_px;
  piece.slope = piece.sagitta_px = 0.0;
  return piece;
}

/// Usable pixels near the line with the light of pieces in them.
std::vector<PiecePixel> pixels_of(const Scene& scene, const Trail& line, const StreakLight& light,
                                  const Psf& psf, double sigma_px) {
  Trail longer = line;
  longer.length_px += 2 * double(pieces_beyond) * light.piece_px;
  const auto near = pixels_near(scene, longer, across_sigmas * sigma_px + across_px);
  std::vector<PiecePixel> out;
  for (const FitPixel& pixel : near) out.push_back({.pixel = pixel, .first = 0, .share = {}});
  const double c = std::cos(line.angle_rad), s = std::sin(line.angle_rad);
  std::vector<FitPixel> reached;
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < light.all_pieces(); ++i) {
    reached.clear(), which.clear();
    for (std::size_t k = 0; k < near.size(); ++k) {
      const double along = (near[k].x - line.x_px) * c + (near[k].y - line.y_px) * s;
      if (std::abs(along - light.along_px(i)) > reach_sigmas * sigma_px + light.piece_px) continue;
      reached.push_back(near[k]), which.push_back(k);
    }
    const Trail piece = piece_of(line, light, i);
    const std::vector<double> share = light_in(reached, {&piece, 1}, psf);
    for (std::size_t k = 0; k < which.size(); ++k) {
      PiecePixel& at = out[which[k]];
      if (at.share.empty()) at.first = i;
      at.share.push_back(share[k]);
    }
  }
  return out;
}

/// Sets the equations for pixels whose light is about `model_e`.
void set_equations(const std::vector<PiecePixel>& pixels, const std::vector<double>& model_e,
                   StreakLight& light) {
  light.matrix = BandedMatrix(light.matrix.size(), light.matrix.band());
  std::ranges::fill(light.right, 0.0);
  std::ranges::fill(light.background, 0.0);
  light.background_weight = light.background_right = 0.0;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const PiecePixel& at = pixels[k];
    const double signal = double(at.pixel.signal_e);
    const double weight = 1 / (double(at.pixel.variance_e2) + std::max(model_e[k], 0.0));
    for (std::size_t a = 0; a < at.share.size(); ++a) {
      const double weighted = weight * at.share[a];
      for (std::size_t b = 0; b <= a; ++b)
        light.matrix.at(at.first + a, at.first + b) += weighted * at.share[b];
      light.right[at.first + a] += weighted * signal;
      light.background[at.first + a] += weighted;
    }
    light.background_weight += weight;
    light.background_right += weight * signal;
  }
  light.background_weight += 1 / std::pow(background_sigma_e(pixels.front().pixel), 2);
  double most = 0.0;
  for (std::size_t i = 0; i < light.matrix.size(); ++i)
    most = std::max(most, light.matrix.at(i, i));
  for (std::size_t i = 0; i < light.matrix.size(); ++i) light.matrix.at(i, i) += weak * most;
}

bool is_beyond(const StreakLight& light, std::size_t piece) {
  return piece < pieces_beyond || piece >= pieces_beyond + light.pieces;
}

/// The bin of a piece; the pieces beyond the ends are bins of their own.
std::size_t bin_of(const StreakLight& light, std::size_t piece) {
  if (piece < pieces_beyond) return piece;
  if (!is_beyond(light, piece)) return pieces_beyond + (piece - pieces_beyond) / pieces_of_bin;
  return piece - light.pieces + light.pieces / pieces_of_bin;
}

/// The equations of bins: light of one is divided evenly among its pieces.
struct BinEquations {
  BandedMatrix matrix;
  std::vector<double> right, background;
};

BinEquations bin_equations(const StreakLight& light) {
  const std::size_t bins = light.pieces / pieces_of_bin + 2 * pieces_beyond;
  BinEquations out{BandedMatrix(bins, light.matrix.band() / pieces_of_bin + 2 * pieces_beyond),
                   std::vector<double>(bins, 0.0), std::vector<double>(bins, 0.0)};
  const auto share = [&](std::size_t piece) {
    return is_beyond(light, piece) ? 1.0 : 1.0 / double(pieces_of_bin);
  };
  for (std::size_t i = 0; i < light.matrix.size(); ++i) {
    const std::size_t a = bin_of(light, i);
    out.right[a] += share(i) * light.right[i];
    out.background[a] += share(i) * light.background[i];
    for (std::size_t j = light.matrix.first_of(i); j <= i; ++j) {
      const std::size_t b = bin_of(light, j);
      const double product = share(i) * share(j) * light.matrix.at(i, j);
      out.matrix.at(a, b) += a == b && i != j ? 2 * product : product;
    }
  }
  return out;
}

/// Equations of bins, solved for their light and an even background.
struct SolvedBins {
  BandedMatrix factor;
  std::vector<double> by_background;  // light by a background of 1
  double weight = 0.0;                // the background's own
  BinnedLight light;                  // without errors; empty: there is no solution
};

SolvedBins solved_light(const StreakLight& light) {
  BinEquations equations = bin_equations(light);
  const std::size_t bins = equations.matrix.size();
  SolvedBins out{.factor = std::move(equations.matrix), .by_background = {}, .light = {}};
  std::vector<bool> is_measured;
  std::vector<double> seen(bins, 0.0);
  for (std::size_t i = 0; i < light.seen.size(); ++i)
    seen[bin_of(light, i)] += light.seen[i] / (is_beyond(light, i) ? 1.0 : double(pieces_of_bin));
  for (const double share : seen) is_measured.push_back(share > least_seen);
  if (!out.factor.factorise()) return out;
  out.by_background = out.factor.solve(equations.background);
  out.light.is_measured = std::move(is_measured);
  out.light.light_e = out.factor.solve(equations.right);
  double right = light.background_right;
  out.weight = light.background_weight;
  for (std::size_t i = 0; i < bins; ++i) {
    out.weight -= equations.background[i] * out.by_background[i];
    right -= equations.background[i] * out.light.light_e[i];
  }
  out.light.background_e = right / out.weight;
  for (std::size_t i = 0; i < bins; ++i)
    out.light.light_e[i] -= out.light.background_e * out.by_background[i];
  return out;
}

/// Light of all bins, those beyond the ends too, with errors.
BinnedLight solved(const StreakLight& light) {
  SolvedBins found = solved_light(light);
  BinnedLight& out = found.light;
  const std::size_t bins = out.light_e.size();
  for (std::size_t i = 0; i < bins; ++i) {
    std::vector<double> one(bins, 0.0);
    one[i] = 1.0;
    const std::vector<double> column = found.factor.solve(std::move(one));
    const double both = found.by_background[i] / found.weight;
    out.variance_e2.push_back(column[i] + found.by_background[i] * both);
    const auto with = [&](std::size_t j) {
      return j < bins ? column[j] + found.by_background[j] * both : 0.0;
    };
    out.next_e2.push_back(with(i + 1));
    out.second_e2.push_back(with(i + 2));
  }
  return std::move(out);
}

/// Light of the bins in pixels.
std::vector<double> model_of(const std::vector<PiecePixel>& pixels, const StreakLight& light,
                             const BinnedLight& bins) {
  std::vector<double> out;
  for (const PiecePixel& at : pixels) {
    double sum = 0.0;
    for (std::size_t k = 0; k < at.share.size(); ++k) {
      const std::size_t piece = at.first + k;
      const double e = bins.light_e[bin_of(light, piece)];
      sum += at.share[k] * (is_beyond(light, piece) ? e : e / double(pieces_of_bin));
    }
    out.push_back(sum);
  }
  return out;
}

double chi2_of(const std::vector<PiecePixel>& pixels, const std::vector<double>& weights_by_e,
               const std::vector<double>& model_e, double background_e) {
  double chi2 = 0.0;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const double off = double(pixels[k].pixel.signal_e) - model_e[k] - background_e;
    chi2 += off * off / (double(pixels[k].pixel.variance_e2) + std::max(weights_by_e[k], 0.0));
  }
  return chi2;
}

/// A line divided into pieces, without equations.
StreakLight divided(const Trail& line, double sigma_px) {
  const double fwhm_px = fwhm_per_sigma * sigma_px;
  const double bins =
      std::clamp(std::round(line.length_px / fwhm_px), 1.0, double(max_pieces / pieces_of_bin));
  const auto pieces = std::size_t(bins) * pieces_of_bin;
  const double piece_px = line.length_px / double(pieces);
  const auto reach = std::size_t(2 * (reach_sigmas * sigma_px / piece_px + 1)) + 2;
  return {.length_px = line.length_px,
          .fwhm_px = fwhm_px,
          .piece_px = piece_px,
          .pieces = pieces,
          .matrix = BandedMatrix(pieces + 2 * pieces_beyond, reach),
          .right = std::vector<double>(pieces + 2 * pieces_beyond, 0.0),
          .background = std::vector<double>(pieces + 2 * pieces_beyond, 0.0),
          .seen = std::vector<double>(pieces + 2 * pieces_beyond, 0.0)};
}

}  // namespace

std::optional<StreakLight> streak_light(const Scene& scene, const Source& source) {
  const Trail& line = source.trail();
  const bool broad = source.broad_sigma_px > 0;
  const PixelPosition middle{line.x_px, line.y_px};
  const Psf psf = broad ? Psf(source.broad_sigma_px) : scene.psf.at(middle);
  const double sigma_px = broad ? source.broad_sigma_px : scene.psf.sigma_at(middle);
  if (!source.streak || line.length_px < min_fwhms * fwhm_per_sigma * sigma_px) return std::nullopt;
  StreakLight light = divided(line, sigma_px);
  const auto pixels = pixels_of(scene, line, light, psf, sigma_px);
  if (pixels.size() < 2 * light.pieces) return std::nullopt;
  std::vector<FitPixel> places;
  for (const PiecePixel& at : pixels) places.push_back(at.pixel);
  std::vector<double> model_e = light_in(places, {&line, 1}, psf);
  for (const PiecePixel& at : pixels)
    for (std::size_t k = 0; k < at.share.size(); ++k) light.seen[at.first + k] += at.share[k];
  for (int pass = 0; pass < passes; ++pass) {
    set_equations(pixels, model_e, light);
    const BinnedLight bins = solved_light(light).light;
    if (bins.light_e.empty()) return std::nullopt;
    const std::vector<double> before = std::exchange(model_e, model_of(pixels, light, bins));
    const double degrees = double(pixels.size()) - double(bins.light_e.size()) - 1;
    light.reduced_chi2 =
        chi2_of(pixels, before, model_e, bins.background_e) / std::max(degrees, 1.0);
  }
  return light;
}

static_assert(pieces_beyond == 3);  // whose covariances are known

std::array<LightBeyond, 2> light_beyond(const StreakLight& light) {
  const BinnedLight all = solved(light);
  const std::size_t bins = all.light_e.size();
  if (bins == 0) return {};
  double even_e = 0.0;
  for (std::size_t i = pieces_beyond; i + pieces_beyond < bins; ++i) even_e += all.light_e[i];
  even_e *= double(pieces_beyond) / double(light.pieces);
  std::array<LightBeyond, 2> out;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t first = side == 0 ? 0 : bins - pieces_beyond;
    double sum = 0.0, variance = 0.0;
    for (std::size_t i = first; i < first + pieces_beyond; ++i) {
      sum += all.light_e[i];
      variance += all.variance_e2[i];
      if (i + 1 < first + pieces_beyond) variance += 2 * all.next_e2[i];
      if (i + 2 < first + pieces_beyond) variance += 2 * all.second_e2[i];
    }
    if (variance > 0 && even_e > 0)
      out[side] = {sum / std::sqrt(variance * light.misfit()), sum / even_e};
  }
  return out;
}

void set_light(const StreakLight& light, Source& source) {
  const BinnedLight bins = binned(light);
  Trail& t = source.fit.trails[0];
  double sum = 0.0, variance = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < bins.light_e.size(); ++i) {
    sum += bins.light_e[i];
    variance += bins.variance_e2[i];
    if (i + 1 < bins.light_e.size()) variance += 2 * bins.next_e2[i];
    if (i + 2 < bins.light_e.size()) variance += 2 * bins.second_e2[i];
    moment += bins.light_e[i] * ((double(i) + 0.5) / double(bins.light_e.size()) - 0.5);
  }
  if (!(sum > 0) || !(variance > 0)) return;
  t.flux_e = sum;
  if (source.free & trail_slope) t.slope = std::clamp(6 * moment / sum, -1.0, 1.0);
  constexpr int flux = 2;
  for (int i = 0; i < source.fit.parameters; ++i)
    if (i != flux) source.fit.add_cov(i, flux, -source.fit.cov(i, flux));
  source.fit.add_cov(flux, flux, variance - source.fit.cov(flux, flux));
}

Source aligned(const Scene& scene, Source source) {
  constexpr double step_px = 0.15, max_px = 0.6;
  constexpr int rounds = 2;
  const auto moved = [&](const Source& from, double offset_px, double end_px) {
    Source out = from;
    Trail& t = out.fit.trails[0];
    t.x_px -= offset_px * std::sin(t.angle_rad);
    t.y_px += offset_px * std::cos(t.angle_rad);
    t.angle_rad += std::atan2(end_px, t.length_px / 2);
    return out;
  };
  const auto chi2 = [&](const Source& at) {
    const auto light = streak_light(scene, at);
    return light ? light->reduced_chi2 : HUGE_VAL;
  };
  for (int round = 0; round < 2 * rounds; ++round) {
    const bool turns = round % 2 == 1;
    const auto by = [&](double px) {
      return turns ? moved(source, 0.0, px) : moved(source, px, 0.0);
    };
    const double before = chi2(by(-step_px)), here = chi2(source), after = chi2(by(step_px));
    const double bend = before - 2 * here + after;
    if (!(bend > 0) || !std::isfinite(bend)) continue;
    const double px = std::clamp(0.5 * step_px * (before - after) / bend, -max_px, max_px);
    Source better = by(px);
    if (chi2(better) < here) source = std::move(better);
  }
  return source;
}

BinnedLight binned(const StreakLight& light) {
  BinnedLight all = solved(light), out;
  out.background_e = all.background_e;
  for (std::size_t i = pieces_beyond; i + pieces_beyond < all.light_e.size(); ++i) {
    out.light_e.push_back(all.light_e[i]);
    out.variance_e2.push_back(all.variance_e2[i] * light.misfit());
    out.next_e2.push_back(all.next_e2[i] * light.misfit());
    out.second_e2.push_back(all.second_e2[i] * light.misfit());
    out.is_measured.push_back(all.is_measured[i]);
  }
  return out;
}

}  // namespace dmise
