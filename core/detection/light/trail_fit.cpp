#include "core/detection/light/trail_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/algebra/small_matrix.h"
#include "core/base/error.h"
#include "core/base/numeric/simd_level.h"
#include "core/detection/light/trail_kernels.h"

namespace dmise {
namespace {

std::vector<TrailLight> lights_of(std::span<const Trail> trails, const Psf& psf) {
  std::vector<TrailLight> out;
  out.reserve(trails.size());
  for (const Trail& trail : trails) out.emplace_back(trail, psf);
  return out;
}

struct State {
  std::vector<Trail> trails;
  double background_e = 0.0;
};

class Problem {
 public:
  Problem(const std::vector<FitPixel>& pixels, const std::vector<unsigned>& free,
          const FitSettings& settings)
      : used_(pixels.size()),
        free_(free),
        settings_(settings),
        fits_background_(settings.background_sigma_e > 0) {
    for (const unsigned mask : free)
      for (unsigned bit = 0; bit < trail_parameters; ++bit) size_ += mask >> bit & 1u;
    size_ += fits_background_ ? 1u : 0u;
    if (size_ > max_parameters) throw Error("trail fit: more than 16 free parameters");
    const std::size_t whole = (used_ + trail_block - 1) / trail_block * trail_block;
    x_.assign(whole, 0.0);
    y_.assign(whole, 0.0);
    signal_.assign(whole, 0.0);
    variance_.assign(whole, 1.0);
    for (std::size_t i = 0; i < used_; ++i) {
      x_[i] = pixels[i].x;
      y_[i] = pixels[i].y;
      signal_[i] = double(pixels[i].signal_e);
      variance_[i] = double(pixels[i].variance_e2);
    }
  }

  std::size_t size() const { return size_; }

  /// One state of the fit. Weights depend on the model, so each state has its own; `merit` is its
  /// chi2 with the weights of the previous state, which a step must reduce.
  struct Linear {
    State state;
    SmallMatrix matrix{};
    SmallVector right{};
    std::vector<double> variance;
    double chi2 = 0.0, deviance = 0.0, merit = 0.0;
  };

  Linear linearise(State state, const std::vector<double>* before) const {
    static const auto trail_light =
        kernel_of(best_simd_level(), sse2::trail_light, avx2::trail_light, avx512::trail_light);
    static const auto add_block =
        kernel_of(best_simd_level(), sse2::add_block, avx2::add_block, avx512::add_block);
    Linear out;
    out.variance.resize(x_.size());
    const std::vector<TrailLight> lights = lights_of(state.trails, settings_.psf);
    std::vector<double> derivatives(trail_parameters * trail_block * lights.size());
    const auto of = [&](std::size_t t) {
      return reinterpret_cast<double(*)[trail_block]>(derivatives.data() +
                                                      t * trail_parameters * trail_block);
    };
    std::array<double, trail_block> ones;
    ones.fill(1.0);
    std::array<const double*, max_parameters> gradients{};
    std::size_t k = 0;
    for (std::size_t t = 0; t < lights.size(); ++t)
      for (unsigned bit = 0; bit < trail_parameters; ++bit)
        if (free_[t] >> bit & 1u) gradients[k++] = of(t)[bit];
    if (fits_background_) gradients[k++] = ones.data();
    TrailSums sums;
    for (std::size_t begin = 0; begin < x_.size(); begin += trail_block) {
      std::array<double, trail_block> model{};
      for (std::size_t t = 0; t < lights.size(); ++t)
        trail_light(lights[t].shape(), normal_table(), x_.data() + begin, y_.data() + begin,
                    model.data(), of(t));
      const TrailPixels pixels{.x = x_.data() + begin,
                               .y = y_.data() + begin,
                               .signal_e = signal_.data() + begin,
                               .variance_e2 = variance_.data() + begin,
                               .before = before ? before->data() + begin : nullptr,
                               .used = std::min(trail_block, used_ - begin)};
      add_block(pixels, model.data(), state.background_e, settings_.model_error, gradients.data(),
                size_, out.variance.data() + begin, sums);
    }
    out.chi2 = sums.chi2;
    out.merit = sums.merit;
    for (std::size_t i = 0; i < size_; ++i) {
      out.right[i] = sums.right[i];
      for (std::size_t j = 0; j <= i; ++j) out.matrix[i][j] = sums.matrix[i][j];
    }
    if (fits_background_) {
      const double weight = 1 / (settings_.background_sigma_e * settings_.background_sigma_e);
      const double penalty = weight * state.background_e * state.background_e;
      out.matrix[size_ - 1][size_ - 1] += weight;
      out.right[size_ - 1] -= weight * state.background_e;
      out.chi2 += penalty;
      out.merit += penalty;
    }
    out.deviance = out.chi2 + sum_of_logarithms(out.variance);
    out.state = std::move(state);
    return out;
  }

  /// Returns the step from a state by its damped equations. A slope at its bound that the step
  /// would take beyond it is held.
  std::optional<SmallVector> step_from(const Linear& now, double damping) const {
    std::vector<std::size_t> held;
    while (true) {
      SmallMatrix damped = now.matrix;
      SmallVector right = now.right;
      for (std::size_t i = 0; i < size_; ++i) damped[i][i] *= 1 + damping;
      for (const std::size_t k : held) {
        for (std::size_t i = 0; i < size_; ++i) damped[std::max(i, k)][std::min(i, k)] = 0.0;
        damped[k][k] = 1.0;
        right[k] = 0.0;
      }
      if (!cholesky(damped, size_)) return std::nullopt;
      const SmallVector step = solve(damped, right, size_);
      const auto beyond = slope_beyond(now.state, step);
      if (!beyond) return step;
      held.push_back(*beyond);
    }
  }

  State moved(const State& from, const SmallVector& step) const {
    State to = from;
    std::size_t k = 0;
    for (std::size_t t = 0; t < to.trails.size(); ++t) {
      Trail& trail = to.trails[t];
      double* const values[trail_parameters] = {&trail.x_px,      &trail.y_px,      &trail.flux_e,
                                                &trail.length_px, &trail.angle_rad, &trail.slope,
                                                &trail.sagitta_px};
      for (unsigned bit = 0; bit < trail_parameters; ++bit)
        if (free_[t] >> bit & 1u) *values[bit] += step[k++];
      trail.length_px = std::max(trail.length_px, 0.0);
      trail.slope = std::clamp(trail.slope, -1.0, 1.0);
    }
    if (fits_background_) to.background_e += step[k];
    return to;
  }

 private:
  /// Takes one logarithm of the product of many variances.
  double sum_of_logarithms(const std::vector<double>& variance) const {
    double logs = 0.0, product = 1.0;
    for (std::size_t i = 0; i < used_; ++i) {
      product *= variance[i];
      if (product > 1e200 || product < 1e-200) {
        logs += std::log(product);
        product = 1.0;
      }
    }
    return logs + std::log(product);
  }

  /// The number of a slope that is 1 or -1 and that a step takes further.
  std::optional<std::size_t> slope_beyond(const State& from, const SmallVector& step) const {
    std::size_t k = 0;
    for (std::size_t t = 0; t < from.trails.size(); ++t)
      for (unsigned bit = 0; bit < trail_parameters; ++bit) {
        if (!(free_[t] >> bit & 1u)) continue;
        const double slope = from.trails[t].slope;
        if (1u << bit == trail_slope && std::abs(slope) >= 1 && slope * step[k] > 0) return k;
        ++k;
      }
    return std::nullopt;
  }

  std::size_t used_;  // pixels; more follow, to whole blocks
  std::vector<double> x_, y_, signal_, variance_;
  const std::vector<unsigned>& free_;
  const FitSettings& settings_;
  bool fits_background_;
  std::size_t size_ = 0;
};

/// Returns the share of a step to take. Weights change with the model, so that steps of an end may
/// alternate about its place, each `-back` times the one before; all of them together are the step
/// over 1 + back.
double share_of_step(const SmallMatrix& matrix, const SmallVector& step, const SmallVector& before,
                     std::size_t n) {
  constexpr double least_back = 0.2;
  double along = 0.0, size = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const double m = matrix[std::max(i, j)][std::min(i, j)];
      along += step[i] * m * before[j];
      size += before[i] * m * before[j];
    }
  const double back = -along / size;
  return back > least_back ? 1 / (1 + back) : 1.0;
}

/// Calls visit(first pixel, count, x, y) for blocks of pixels.
template <class Visit>
void for_blocks(std::span<const FitPixel> pixels, const Visit& visit) {
  std::array<double, trail_block> x{}, y{};
  for (std::size_t begin = 0; begin < pixels.size(); begin += trail_block) {
    const std::size_t count = std::min(trail_block, pixels.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = pixels[begin + i].x;
      y[i] = pixels[begin + i].y;
    }
    visit(begin, count, x.data(), y.data());
  }
}

}  // namespace

std::vector<double> light_in(std::span<const FitPixel> pixels, std::span<const Trail> trails,
                             const Psf& psf) {
  static const auto trail_values =
      kernel_of(best_simd_level(), sse2::trail_values, avx2::trail_values, avx512::trail_values);
  const std::vector<TrailLight> lights = lights_of(trails, psf);
  std::vector<double> out((pixels.size() + trail_block - 1) / trail_block * trail_block, 0.0);
  for_blocks(pixels, [&](std::size_t begin, std::size_t, const double* x, const double* y) {
    for (const TrailLight& light : lights)
      trail_values(light.shape(), normal_table(), x, y, out.data() + begin);
  });
  out.resize(pixels.size());
  return out;
}

std::vector<PlacedLight> placed_light_in(std::span<const FitPixel> pixels,
                                         const TrailLight& light) {
  static const auto trail_light =
      kernel_of(best_simd_level(), sse2::trail_light, avx2::trail_light, avx512::trail_light);
  std::vector<PlacedLight> out;
  out.reserve(pixels.size());
  for_blocks(pixels, [&](std::size_t, std::size_t count, const double* x, const double* y) {
    std::array<double, trail_block> value{};
    double by[trail_parameters][trail_block];
    trail_light(light.shape(), normal_table(), x, y, value.data(), by);
    for (std::size_t i = 0; i < count; ++i) out.push_back({value[i], by[0][i], by[1][i]});
  });
  return out;
}

bool TrailFit::good(double sigmas) const {
  return degrees > 0 && chi2 <= degrees + sigmas * std::sqrt(2.0 * degrees);
}

TrailFit fit_trails(const std::vector<FitPixel>& pixels, std::vector<Trail> start,
                    const std::vector<unsigned>& free, const FitSettings& settings) {
  const Problem problem(pixels, free, settings);
  const std::size_t n = problem.size();
  constexpr double near_chi2 = 1.0;
  TrailFit fit;
  double damping = 1e-3;
  SmallVector before{};
  bool swings = false;  // whether the step may be one about the place
  Problem::Linear now = problem.linearise({std::move(start), 0.0}, nullptr);
  fit.degrees = int(pixels.size()) - int(n) + (settings.background_sigma_e > 0 ? 1 : 0);
  for (int step = 0; step < settings.max_steps && !fit.converged; ++step) {
    fit.chi2 = now.chi2;
    if (settings.good_enough_sigmas && fit.good(*settings.good_enough_sigmas)) break;
    std::optional<SmallVector> by = problem.step_from(now, damping);
    if (!by) break;
    const double share = swings ? share_of_step(now.matrix, *by, before, n) : 1.0;
    for (std::size_t i = 0; i < n; ++i) (*by)[i] *= share;
    Problem::Linear trial = problem.linearise(problem.moved(now.state, *by), &now.variance);
    const double gain = now.chi2 - trial.merit;
    fit.converged = std::abs(gain) < settings.settled_chi2;
    if (gain < 0 || !std::isfinite(trial.merit)) {
      damping *= 10;
      swings = false;
      continue;
    }
    now = std::move(trial);
    before = *by;
    swings = gain < near_chi2;
    damping *= 0.1;
  }
  State& state = now.state;
  SmallMatrix& matrix = now.matrix;
  fit.chi2 = now.chi2;
  fit.deviance = now.deviance;
  fit.trails = std::move(state.trails);
  fit.background_e = state.background_e;
  fit.parameters = int(n);
  fit.covariance.assign(n * n, 0.0);
  if (cholesky(matrix, n)) {
    for (std::size_t i = 0; i < n; ++i) {
      const SmallVector column = inverse_column(matrix, i, n);
      for (std::size_t j = 0; j < n; ++j) fit.covariance[j * n + i] = column[j];
    }
  } else {
    fit.converged = false;
  }
  return fit;
}

}  // namespace dmise
