#pragma once
#include <complex>
#include <memory>
#include <vector>

#include "core/base/parallel.h"

// Transforms by FFTW in single precision. Plans are estimated, never measured, and every thread
// transforms whole groups of a fixed number of rows or columns: the bytes depend neither on timing
// nor on the number of threads. On another instruction set FFTW may choose other code, and results
// differ by rounding, below 3e-7 of the largest value.
namespace dmise {

/// Smallest n >= at_least whose prime factors are 2, 3, 5 and 7; even if asked for. at_least >= 1.
int good_fft_size(int at_least, bool even = false);

/// Memory aligned as FFTW likes it, all zero at first.
class FftBuffer {
 public:
  FftBuffer() = default;
  explicit FftBuffer(std::size_t floats);
  float* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  std::complex<float>* complex_data() const {
    return reinterpret_cast<std::complex<float>*>(data_.get());
  }

 private:
  struct Free {
    void operator()(float* p) const;
  };
  std::unique_ptr<float, Free> data_;
  std::size_t size_ = 0;
};

/// Real transform of an image in place. A row of `columns` floats stands at the start of `stride`
/// floats; its half spectrum, columns / 2 + 1 complex numbers, takes their place.
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

  /// Half spectrum of the image, as `spectrum` for `convolve`: columns in groups, scaled so that
  /// `convolve` with the spectrum of a unit impulse at (0, 0) changes nothing. Overwrites the
  /// image.
  using Spectrum = std::vector<std::complex<float>>;
  Spectrum spectrum(FftBuffer& image, Threads& threads) const;
  void spectrum(FftBuffer& image, Threads& threads, Spectrum& result) const;

  /// Circular convolution in place with the image whose spectrum is given. Rows that are not `lit`
  /// are taken as zero whatever they hold; only rows [wanted_begin, wanted_end) are made.
  void convolve(FftBuffer& image, const std::vector<char>& lit, int wanted_begin, int wanted_end,
                const Spectrum& spectrum, Threads& threads) const;

  /// The same in two halves, so that images with kernels of their own share one inverse transform:
  /// adds the product of two spectra to `sum`, which starts as zeros, and transforms back.
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

/// Complex transform of a square of side n, in place, sign as FFTW_FORWARD, not normalised. For
/// pupils and screens, which are small.
class ComplexFft2 {
 public:
  explicit ComplexFft2(int side);
  ~ComplexFft2();
  ComplexFft2(const ComplexFft2&) = delete;
  ComplexFft2& operator=(const ComplexFft2&) = delete;
  int side() const { return side_; }
  /// side x side complex numbers, row-major.
  void transform(FftBuffer& data) const;

 private:
  void* plan_ = nullptr;
  int side_;
};

}  // namespace dmise
