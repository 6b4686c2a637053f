#include "core/detection/light/trail_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/base/numeric/simd_level.h"
#include "core/detection/light/trail_light.h"

namespace dmise {
namespace {

struct Kernels {
  decltype(&sse2::trail_light) trail_light;
  decltype(&sse2::trail_values) trail_values;
  decltype(&sse2::add_block) add_block;
};

std::vector<Kernels> levels() {
  std::vector<Kernels> out{{sse2::trail_light, sse2::trail_values, sse2::add_block}};
  if (best_simd_level() >= SimdLevel::avx2)
    out.push_back({avx2::trail_light, avx2::trail_values, avx2::add_block});
  if (best_simd_level() >= SimdLevel::avx512)
    out.push_back({avx512::trail_light, avx512::trail_values, avx512::add_block});
  return out;
}

using Block = std::array<double, trail_block>;

/// Pixels about the place (20, 30), of which some are far from all light.
struct Pixels {
  Block x{}, y{}, signal{}, variance{};

  Pixels() {
    for (std::size_t i = 0; i < trail_block; ++i) {
      x[i] = 12.0 + double(i * 7 % 17);
      y[i] = 24.0 + double(i * 11 % 13) + (i % 9 == 0 ? 40.0 : 0.0);
      signal[i] = 10.0 * double(i % 5) - 8.0;
      variance[i] = 20.0 + double(i % 3);
    }
  }
};

/// A point, a short and a long one, bent and of a slope, of an elliptical and of a narrow PSF.
std::vector<TrailLight> lights() {
  Psf narrow(0.6), ellipse(1.3);
  ellipse.along_x = 0.2, ellipse.along_diagonal = -0.1;
  Psf mixture;
  mixture.count = 2;
  mixture.parts[0] = {0.8, 0.9};
  mixture.parts[1] = {0.2, 2.4};
  std::vector<TrailLight> out;
  for (const Psf& psf : {narrow, ellipse, mixture})
    for (const Trail& trail : {Trail{20.2, 29.7, 900.0}, Trail{19.6, 30.4, 1500.0, 3.0, 0.4},
                               Trail{20.0, 30.0, 3000.0, 14.0, 2.5, 0.6, 0.7}})
      out.emplace_back(trail, psf);
  return out;
}

TEST(TrailKernels, LightIsThatOfEachPixelOnEveryInstructionSet) {
  const Pixels pixels;
  for (const TrailLight& light : lights()) {
    std::vector<double> first;
    for (const Kernels& kernels : levels()) {
      Block model{};
      double derivatives[trail_parameters][trail_block];
      kernels.trail_light(light.shape(), normal_table(), pixels.x.data(), pixels.y.data(),
                          model.data(), derivatives);
      Block values{};
      kernels.trail_values(light.shape(), normal_table(), pixels.x.data(), pixels.y.data(),
                           values.data());
      EXPECT_EQ(values, model);
      std::vector<double> all(model.begin(), model.end());
      for (const auto& row : derivatives) all.insert(all.end(), row, row + trail_block);
      if (first.empty()) first = all;
      EXPECT_EQ(all, first);
    }
    for (std::size_t i = 0; i < trail_block; ++i) {
      TrailDerivatives by{};
      const double value = light(pixels.x[i], pixels.y[i], by);
      EXPECT_NEAR(first[i], value, 1e-9 * (1 + std::abs(value)));
      for (std::size_t k = 0; k < trail_parameters; ++k)
        EXPECT_NEAR(first[(k + 1) * trail_block + i], by[k], 1e-9 * (1 + std::abs(by[k])));
    }
  }
}

// The sums of a weighted least-squares problem, written out.
TEST(TrailKernels, ABlockAddsItsNormalEquationsOnEveryInstructionSet) {
  const Pixels pixels;
  Block model{}, one{}, two{}, before{};
  for (std::size_t i = 0; i < trail_block; ++i) {
    model[i] = double(i % 7) * 3.0 - 2.0;
    one[i] = 0.1 * double(i % 4) - 0.2;
    two[i] = 1.0;
    before[i] = 30.0 + double(i % 6);
  }
  constexpr double background = 1.5, model_error = 0.1;
  const std::array<const double*, 2> gradients{one.data(), two.data()};
  for (const std::size_t used : {std::size_t(1), std::size_t(37), trail_block}) {
    double right0 = 0.0, matrix10 = 0.0, chi2 = 0.0, merit = 0.0;
    for (std::size_t i = 0; i < used; ++i) {
      const double variance = pixels.variance[i] + std::max(model[i], 0.0) +
                              model_error * model_error * model[i] * model[i];
      const double residual = pixels.signal[i] - model[i] - background;
      right0 += one[i] * residual / variance;
      matrix10 += one[i] * two[i] / variance;
      chi2 += residual * residual / variance;
      merit += residual * residual / before[i];
    }
    std::array<double, 4> first{};
    for (const Kernels& kernels : levels()) {
      TrailSums sums;
      Block variance{};
      kernels.add_block({.x = pixels.x.data(),
                         .y = pixels.y.data(),
                         .signal_e = pixels.signal.data(),
                         .variance_e2 = pixels.variance.data(),
                         .before = before.data(),
                         .used = used},
                        model.data(), background, model_error, gradients.data(), 2, variance.data(),
                        sums);
      const std::array all{sums.right[0], sums.matrix[1][0], sums.chi2, sums.merit};
      if (first == std::array<double, 4>{}) first = all;
      EXPECT_EQ(all, first);
      EXPECT_NEAR(all[0], right0, 1e-12 * (1 + std::abs(right0)));
      EXPECT_NEAR(all[1], matrix10, 1e-12);
      EXPECT_NEAR(all[2], chi2, 1e-12 * chi2);
      EXPECT_NEAR(all[3], merit, 1e-12 * merit);
    }
  }
}

}  // namespace
}  // namespace dmise
