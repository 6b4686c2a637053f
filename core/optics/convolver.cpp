#include "core/optics/convolver.h"

#include <algorithm>
#include <numeric>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr std::size_t row_grain = 16;

}  // namespace

Convolver::Convolver(int columns, int rows, const PsfKernel& kernel, Threads& threads)
    : columns_(columns),
      rows_(rows),
      fft_(good_fft_size(std::max(columns + kernel.half, kernel.side()), true),
           good_fft_size(std::max(rows + kernel.half, kernel.side()))),
      padded_(fft_.floats()) {
  for (int dy = -kernel.half; dy <= kernel.half; ++dy)
    for (int dx = -kernel.half; dx <= kernel.half; ++dx) {
      const int y = (dy + fft_.rows()) % fft_.rows(), x = (dx + fft_.columns()) % fft_.columns();
      padded_.data()[std::size_t(y) * std::size_t(fft_.stride()) + std::size_t(x)] =
          kernel.at(dx, dy);
    }
  spectrum_ = fft_.spectrum(padded_, threads);
}

void Convolver::apply(RateImage& image, Threads& threads) {
  if (image.columns != columns_ || image.rows != rows_) throw Error("convolver: size of the image");
  const auto columns = std::size_t(columns_), stride = std::size_t(fft_.stride());
  std::vector<char> lit(std::size_t(fft_.rows()));
  threads.for_ranges(std::size_t(rows_), row_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const float* in = image.row(int(y));
      float* out = padded_.data() + y * stride;
      std::copy_n(in, columns, out);
      std::fill(out + columns, out + stride, 0.0f);
      lit[y] = std::any_of(in, in + columns, [](float e) { return e != 0.0f; });
    }
  });
  if (std::none_of(lit.begin(), lit.end(), [](char row) { return row; })) return;

  fft_.convolve(padded_, lit, 0, rows_, spectrum_, threads);

  struct Sums {
    double all = 0.0, dark = 0.0;
  };
  std::vector<Sums> sums(static_cast<std::size_t>(rows_));
  threads.for_ranges(std::size_t(rows_), row_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const float* in = padded_.data() + y * stride;
      float* out = image.row(int(y));
      double bright = 0.0, dark = 0.0;
      for (std::size_t x = 0; x < columns; ++x) {
        const float e = in[x];
        bright += e > 0.0f ? e : 0.0f;
        dark += e > 0.0f ? 0.0f : e;
        out[x] = e > 0.0f ? e : 0.0f;
      }
      sums[y] = {bright, dark};
    }
  });
  Sums total;
  for (const Sums& s : sums) {
    total.all += s.all;
    total.dark += s.dark;
  }
  if (!(total.dark < 0.0 && total.all > 0.0)) return;
  const auto scale = float(std::max(0.0, (total.all + total.dark) / total.all));
  threads.for_ranges(std::size_t(rows_), row_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * columns; i < end * columns; ++i) image.pixels[i] *= scale;
  });
}

std::size_t Convolver::memory_bytes() const {
  return padded_.size() * sizeof(float) + spectrum_.size() * sizeof(spectrum_[0]);
}

}  // namespace dmise
