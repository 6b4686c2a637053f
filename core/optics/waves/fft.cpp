#include "core/optics/waves/fft.h"

#include <fftw3.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <span>

#include "core/base/error.h"
#include "core/base/memory.h"

namespace dmise {
namespace {

constexpr int row_group = 8;
constexpr int column_group = 16;  // complex numbers: 128 bytes of a row
constexpr unsigned flags = FFTW_ESTIMATE;

// FFTW's planner is not thread-safe.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

fftwf_complex* as_fftw(float* p) { return reinterpret_cast<fftwf_complex*>(p); }

}  // namespace

int good_fft_size(int at_least, bool even) {
  for (int n = std::max(1, at_least);; ++n) {
    if (even && n % 2) continue;
    int rest = n;
    for (int prime : {2, 3, 5, 7})
      while (rest % prime == 0) rest /= prime;
    if (rest == 1) return n;
  }
}

void FftBuffer::Free::operator()(float* p) const { fftwf_free(p); }

FftBuffer::FftBuffer(std::size_t floats) : data_(fftwf_alloc_real(floats)), size_(floats) {
  if (!data_) throw Error("fft: no memory for " + std::to_string(floats) + " numbers");
  prefer_large_pages(std::as_writable_bytes(std::span(data_.get(), floats)));
  std::memset(data_.get(), 0, floats * sizeof(float));
}

// Rows are planned in groups and singly (for the remainder); columns in groups of a work area.
struct RealFft2::Plans {
  fftwf_plan rows_forward = nullptr, rows_inverse = nullptr;
  fftwf_plan row_forward = nullptr, row_inverse = nullptr;
  fftwf_plan columns_forward = nullptr, columns_inverse = nullptr;

  ~Plans() {
    std::lock_guard lock(planner());
    for (fftwf_plan plan :
         {rows_forward, rows_inverse, row_forward, row_inverse, columns_forward, columns_inverse})
      if (plan) fftwf_destroy_plan(plan);
  }
};

RealFft2::RealFft2(int columns, int rows) : plans_(new Plans), columns_(columns), rows_(rows) {
  if (columns < 2 || columns % 2 || rows < 1) throw Error("fft: columns must be even, rows >= 1");
  const int half = columns / 2 + 1;
  const int groups = (half + column_group - 1) / column_group;
  stride_ = 2 * column_group * groups;
  FftBuffer image(std::size_t(stride_) * row_group);
  FftBuffer work(std::size_t(2 * column_group) * std::size_t(rows));
  std::lock_guard lock(planner());
  const auto plan_rows = [&](int count, fftwf_plan& forward, fftwf_plan& inverse) {
    float* p = image.data();
    forward = fftwf_plan_many_dft_r2c(1, &columns_, count, p, nullptr, 1, stride_, as_fftw(p),
                                      nullptr, 1, stride_ / 2, flags);
    inverse = fftwf_plan_many_dft_c2r(1, &columns_, count, as_fftw(p), nullptr, 1, stride_ / 2, p,
                                      nullptr, 1, stride_, flags);
  };
  plan_rows(row_group, plans_->rows_forward, plans_->rows_inverse);
  plan_rows(1, plans_->row_forward, plans_->row_inverse);
  const auto plan_columns = [&](int sign) {
    fftwf_complex* p = as_fftw(work.data());
    return fftwf_plan_many_dft(1, &rows_, column_group, p, nullptr, column_group, 1, p, nullptr,
                               column_group, 1, sign, flags);
  };
  plans_->columns_forward = plan_columns(FFTW_FORWARD);
  plans_->columns_inverse = plan_columns(FFTW_BACKWARD);
}

RealFft2::~RealFft2() = default;

// Transforms whole groups of rows if one of them has light, so that the plan, and with it every
// bit, does not depend on the others.
void RealFft2::forward_rows(FftBuffer& image, const std::vector<char>& lit,
                            Threads& threads) const {
  threads.for_ranges(std::size_t(rows_), row_group, [&](std::size_t begin, std::size_t end) {
    if (std::none_of(&lit[begin], &lit[begin] + (end - begin), [](char l) { return l; })) return;
    for (std::size_t y = begin; y < end; ++y) {
      float* row = image.data() + y * std::size_t(stride_);
      if (!lit[y]) std::fill(row, row + stride_, 0.0f);
      if (end - begin < row_group) fftwf_execute_dft_r2c(plans_->row_forward, row, as_fftw(row));
    }
    float* first = image.data() + begin * std::size_t(stride_);
    if (end - begin == row_group)
      fftwf_execute_dft_r2c(plans_->rows_forward, first, as_fftw(first));
  });
}

void RealFft2::inverse_rows(FftBuffer& image, int wanted_begin, int wanted_end,
                            Threads& threads) const {
  threads.for_ranges(std::size_t(rows_), row_group, [&](std::size_t begin, std::size_t end) {
    if (int(begin) >= wanted_end || int(end) <= wanted_begin) return;
    for (std::size_t y = begin; y < end; ++y) {
      float* row = image.data() + y * std::size_t(stride_);
      if (int(y) < wanted_begin || int(y) >= wanted_end) std::fill(row, row + stride_, 0.0f);
      if (end - begin < row_group) fftwf_execute_dft_c2r(plans_->row_inverse, as_fftw(row), row);
    }
    float* first = image.data() + begin * std::size_t(stride_);
    if (end - begin == row_group)
      fftwf_execute_dft_c2r(plans_->rows_inverse, as_fftw(first), first);
  });
}

// Calls use(group, work) for each group of columns; `work` belongs to the thread and is reused.
template <class Use>
void RealFft2::column_groups(Threads& threads, const Use& use) const {
  const auto groups = std::size_t(stride_ / (2 * column_group));
  const std::size_t floats = 2 * column_group * std::size_t(rows_);
  threads.for_ranges(groups, 1, [&](std::size_t begin, std::size_t end) {
    thread_local FftBuffer work;
    if (work.size() < floats) work = FftBuffer(floats);
    for (std::size_t g = begin; g < end; ++g) use(g, work.data());
  });
}

void RealFft2::gather(const FftBuffer& image, std::size_t group, const std::vector<char>& lit,
                      float* work) const {
  constexpr std::size_t width = 2 * column_group;
  for (std::size_t y = 0; y < std::size_t(rows_); ++y) {
    float* to = work + y * width;
    if (lit[y])
      std::memcpy(to, image.data() + y * std::size_t(stride_) + group * width,
                  width * sizeof(float));
    else
      std::fill(to, to + width, 0.0f);
  }
}

void RealFft2::scatter(const float* work, std::size_t group, int begin, int end,
                       FftBuffer& image) const {
  constexpr std::size_t width = 2 * column_group;
  for (std::size_t y = std::size_t(begin); y < std::size_t(end); ++y)
    std::memcpy(image.data() + y * std::size_t(stride_) + group * width, work + y * width,
                width * sizeof(float));
}

void RealFft2::multiply(float* w, std::size_t group, const Spectrum& spectrum) const {
  const std::size_t each = std::size_t(column_group) * std::size_t(rows_);
  const auto* s = reinterpret_cast<const float*>(spectrum.data() + group * each);
  for (std::size_t i = 0; i < 2 * each; i += 2) {
    const float re = w[i] * s[i] - w[i + 1] * s[i + 1];
    w[i + 1] = w[i] * s[i + 1] + w[i + 1] * s[i];
    w[i] = re;
  }
}

void RealFft2::spectrum(FftBuffer& image, Threads& threads, Spectrum& result) const {
  const std::vector<char> lit(std::size_t(rows_), 1);
  forward_rows(image, lit, threads);
  const std::size_t each = std::size_t(column_group) * std::size_t(rows_);
  result.resize(each * std::size_t(stride_ / (2 * column_group)));
  const float scale = float(1.0 / (double(columns_) * rows_));
  column_groups(threads, [&](std::size_t g, float* work) {
    gather(image, g, lit, work);
    fftwf_execute_dft(plans_->columns_forward, as_fftw(work), as_fftw(work));
    const auto* values = reinterpret_cast<const std::complex<float>*>(work);
    for (std::size_t i = 0; i < each; ++i) result[g * each + i] = values[i] * scale;
  });
}

void RealFft2::convolve(FftBuffer& image, const std::vector<char>& lit, int wanted_begin,
                        int wanted_end, const Spectrum& spectrum, Threads& threads) const {
  forward_rows(image, lit, threads);
  column_groups(threads, [&](std::size_t g, float* work) {
    gather(image, g, lit, work);
    fftwf_execute_dft(plans_->columns_forward, as_fftw(work), as_fftw(work));
    multiply(work, g, spectrum);
    fftwf_execute_dft(plans_->columns_inverse, as_fftw(work), as_fftw(work));
    scatter(work, g, wanted_begin, wanted_end, image);
  });
  inverse_rows(image, wanted_begin, wanted_end, threads);
}

void RealFft2::add_product(FftBuffer& image, const std::vector<char>& lit, const Spectrum& spectrum,
                           FftBuffer& sum, Threads& threads) const {
  forward_rows(image, lit, threads);
  constexpr std::size_t width = 2 * column_group;
  column_groups(threads, [&](std::size_t g, float* work) {
    gather(image, g, lit, work);
    fftwf_execute_dft(plans_->columns_forward, as_fftw(work), as_fftw(work));
    multiply(work, g, spectrum);
    for (std::size_t y = 0; y < std::size_t(rows_); ++y) {
      float* to = sum.data() + y * std::size_t(stride_) + g * width;
      for (std::size_t i = 0; i < width; ++i) to[i] += work[y * width + i];
    }
  });
}

void RealFft2::invert(FftBuffer& sum, int wanted_begin, int wanted_end, Threads& threads) const {
  const std::vector<char> lit(std::size_t(rows_), 1);
  column_groups(threads, [&](std::size_t g, float* work) {
    gather(sum, g, lit, work);
    fftwf_execute_dft(plans_->columns_inverse, as_fftw(work), as_fftw(work));
    scatter(work, g, wanted_begin, wanted_end, sum);
  });
  inverse_rows(sum, wanted_begin, wanted_end, threads);
}

ComplexFft2::ComplexFft2(int side) {
  if (side < 1) throw Error("fft: side must be >= 1");
  FftBuffer data(2 * std::size_t(side) * std::size_t(side));
  std::lock_guard lock(planner());
  plan_ = fftwf_plan_dft_2d(side, side, as_fftw(data.data()), as_fftw(data.data()), FFTW_FORWARD,
                            flags);
}

ComplexFft2::~ComplexFft2() {
  std::lock_guard lock(planner());
  fftwf_destroy_plan(static_cast<fftwf_plan>(plan_));
}

void ComplexFft2::transform(FftBuffer& data) const {
  fftwf_execute_dft(static_cast<fftwf_plan>(plan_), as_fftw(data.data()), as_fftw(data.data()));
}

}  // namespace dmise
