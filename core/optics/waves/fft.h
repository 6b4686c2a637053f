#pragma once
#include <complex>
#include <memory>
#include <vector>

#include "core/base/parallel.h"

// Single-precision transforms by FFTW. Plans are estimated, never measured, and every thread
// transforms whole groups of a fixed number of rows or columns: the bytes depend neither on timing
// nor on the number of threads. On another instruction set FFTW may use other code, and results
// differ by rounding, below 3e-7 of the largest value.
namespace dmise {

/// Smallest n >= at_least whose prime factors are 2, 3, 5 and 7; even if asked for. at_least >= 1.
int good_fft_size(int at_least, bool even = false);

/// Zero-initialised memory with FFTW's alignment.
class FftBuffer {
 public:
  FftBuffer() = default;
  explicit FftBuffer(std::size_t floats);
  float* data() const { return data_.get(); }
  std::size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(float* p) const;
  };
  std::unique_ptr<float, Free> data_;
  std::size_t size_ = 0;
};

/// In-place real transform of an image. A row of `columns` floats is stored in `stride` floats; its
/// half spectrum of columns / 2 + 1 complex numbers replaces it.
class RealFft2 {
 public:
  /// `columns` even.
  RealFft2(int columns, int rows);
  ~RealFft2();
  RealFft2(const RealFft2&) = delete;
  RealFft2& operator=(const RealFft2&) = delete;

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int stride() const { return stride_; }
  std::size_t floats() const { return std::size_t(stride_) * std::size_t(rows_); }

  /// Half spectrum of the image for `convolve`: columns in groups, scaled so that convolving with
  /// the spectrum of a unit impulse at (0, 0) is the identity. Overwrites the image.
  using Spectrum = std::vector<std::complex<float>>;
  void spectrum(FftBuffer& image, Threads& threads, Spectrum& result) const;

  /// In-place circular convolution with the image of the given spectrum. Rows that are not `lit`
  /// are treated as zero; only rows [wanted_begin, wanted_end) are computed.
  void convolve(FftBuffer& image, const std::vector<char>& lit, int wanted_begin, int wanted_end,
                const Spectrum& spectrum, Threads& threads) const;

  /// Convolves in two steps, so that images with different kernels share one inverse transform:
  /// adds the product of two spectra to `sum`, initially zero, and transforms back.
  void add_product(FftBuffer& image, const std::vector<char>& lit, const Spectrum& spectrum,
                   FftBuffer& sum, Threads& threads) const;
  void invert(FftBuffer& sum, int wanted_begin, int wanted_end, Threads& threads) const;

 private:
  template <class Use>
  void column_groups(Threads& threads, const Use& use) const;
  void gather(const FftBuffer& image, std::size_t group, const std::vector<char>& lit,
              float* work) const;
  void scatter(const float* work, std::size_t group, int begin, int end, FftBuffer& image) const;
  void multiply(float* work, std::size_t group, const Spectrum& spectrum) const;
  void forward_rows(FftBuffer& image, const std::vector<char>& lit, Threads& threads) const;
  void inverse_rows(FftBuffer& image, int begin, int end, Threads& threads) const;

  struct Plans;
  std::unique_ptr<Plans> plans_;
  int columns_, rows_, stride_;
};

/// In-place complex transform of a square of side n, sign FFTW_FORWARD, not normalised. For pupils
/// and phase screens, which are small.
class ComplexFft2 {
 public:
  explicit ComplexFft2(int side);
  ~ComplexFft2();
  ComplexFft2(const ComplexFft2&) = delete;
  ComplexFft2& operator=(const ComplexFft2&) = delete;
  /// side x side complex numbers, row-major.
  void transform(FftBuffer& data) const;

 private:
  void* plan_ = nullptr;
};

}  // namespace dmise
