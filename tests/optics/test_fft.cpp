#include <fftw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "core/base/numeric/rng.h"
#include "core/optics/waves/fft.h"

namespace dmise {
namespace {

constexpr int columns = 700, rows = 480;

/// Stars of six decades on a sky that is not transformed, and a blur of 3 pixels around (0, 0).
std::vector<float> stars() {
  std::vector<float> image(std::size_t(columns) * rows);
  std::uint64_t state = 1;
  for (int k = 0; k < 300; ++k) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    image[(state >> 20) % image.size()] = std::pow(10.0f, 6.0f * float(k) / 300.0f);
  }
  return image;
}

std::vector<float> blur() {
  std::vector<float> image(std::size_t(columns) * rows);
  double sum = 0.0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const double dx = std::min(x, columns - x), dy = std::min(y, rows - y);
      const double value = std::exp(-(dx * dx + dy * dy) / 18.0);
      image[std::size_t(y) * columns + std::size_t(x)] = float(value);
      sum += value;
    }
  for (float& value : image) value = float(value / sum);
  return image;
}

FftBuffer as_buffer(const RealFft2& fft, const std::vector<float>& image) {
  FftBuffer buffer(fft.floats());
  for (int y = 0; y < rows; ++y)
    std::copy_n(image.data() + std::size_t(y) * columns, columns,
                buffer.data() + std::size_t(y) * std::size_t(fft.stride()));
  return buffer;
}

std::vector<float> convolved(const std::vector<float>& image, const std::vector<float>& kernel) {
  Threads threads(1);
  const RealFft2 fft(columns, rows);
  FftBuffer kernel_buffer = as_buffer(fft, kernel), buffer = as_buffer(fft, image);
  RealFft2::Spectrum spectrum;
  fft.spectrum(kernel_buffer, threads, spectrum);
  fft.convolve(buffer, std::vector<char>(rows, 1), 0, rows, spectrum, threads);
  std::vector<float> out(image.size());
  for (int y = 0; y < rows; ++y)
    std::copy_n(buffer.data() + std::size_t(y) * std::size_t(fft.stride()), columns,
                out.data() + std::size_t(y) * columns);
  return out;
}

/// A convolution by FFTW's scalar code.
std::vector<float> convolved_by_scalar_code(std::vector<float> image, std::vector<float> kernel) {
  const std::size_t half = std::size_t(columns / 2 + 1) * rows;
  std::vector<std::complex<float>> a(half), b(half);
  constexpr unsigned scalar = FFTW_ESTIMATE | FFTW_NO_SIMD;
  const auto transform = [&](std::vector<float>& from, std::vector<std::complex<float>>& to) {
    const fftwf_plan plan = fftwf_plan_dft_r2c_2d(
        rows, columns, from.data(), reinterpret_cast<fftwf_complex*>(to.data()), scalar);
    fftwf_execute(plan);
    fftwf_destroy_plan(plan);
  };
  transform(image, a);
  transform(kernel, b);
  for (std::size_t k = 0; k < half; ++k) a[k] *= b[k] / float(image.size());
  const fftwf_plan plan = fftwf_plan_dft_c2r_2d(
      rows, columns, reinterpret_cast<fftwf_complex*>(a.data()), image.data(), scalar);
  fftwf_execute(plan);
  fftwf_destroy_plan(plan);
  return image;
}

// FFTW chooses its code by the processor. What another instruction set may change is rounding: here
// against the code for a processor without vectors.
TEST(Fft, OfAnotherInstructionSetDiffersByThreeTenMillionthsOfTheBrightestCell) {
  const auto image = stars(), kernel = blur();
  const auto ours = convolved(image, kernel), scalar = convolved_by_scalar_code(image, kernel);
  const float brightest = *std::max_element(ours.begin(), ours.end());
  float worst = 0.0f;
  for (std::size_t k = 0; k < ours.size(); ++k)
    worst = std::max(worst, std::abs(ours[k] - scalar[k]));
  RecordProperty("worst_of_brightest", std::to_string(worst / brightest));
  EXPECT_GT(worst, 0.0f);
  EXPECT_LE(worst, 3e-7f * brightest);
}

}  // namespace
}  // namespace dmise
