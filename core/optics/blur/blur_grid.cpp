#include "core/optics/blur/blur_grid.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/optics/blur/resample.h"

namespace dmise {
namespace {

constexpr std::size_t row_grain = 8;

// Linear interpolation weight of node `node`, one of `count` evenly spaced over `length` pixels: 1
// there, 0 at its neighbours. A single node has weight 1 everywhere.
float hat(int node, int count, double at, double length) {
  if (count == 1) return 1.0f;
  const double x = std::clamp(at / (length - 1.0), 0.0, 1.0) * (count - 1);
  return float(std::max(0.0, 1.0 - std::abs(x - node)));
}

void set_to_zero(FftBuffer& image, const RealFft2& fft, Threads& threads) {
  const auto stride = std::size_t(fft.stride());
  threads.for_ranges(std::size_t(fft.rows()), row_grain, [&](std::size_t begin, std::size_t end) {
    std::fill(image.data() + begin * stride, image.data() + end * stride, 0.0f);
  });
}

}  // namespace

BlurGrid::BlurGrid(int columns, int rows, int oversampling, int half_cells, int field_columns,
                   int field_rows, bool in_tiles)
    : columns_(columns),
      rows_(rows),
      oversampling_(oversampling),
      half_(half_cells),
      field_columns_(columns > 1 ? field_columns : 1),
      field_rows_(rows > 1 ? field_rows : 1),
      fft_(good_fft_size(columns * oversampling + 2 * half_cells, true),
           good_fft_size(rows * oversampling + 2 * half_cells)),
      cells_(fft_.floats()),
      lit_(std::size_t(fft_.rows())),
      of_row_(std::size_t(rows)) {
  if (!in_tiles || field_columns_ * field_rows_ == 1) return;
  const auto widest = [&](int count, int length, int grid_cells) {
    int cells = 0;
    for (int node = 0; node < count; ++node) {
      const Range range = tile_along(node, count, length, grid_cells);
      cells = std::max(cells, range.end - range.begin);
    }
    return cells + 2 * half_;
  };
  tile_ = std::make_unique<RealFft2>(
      good_fft_size(widest(field_columns_, columns_, fft_.columns()), true),
      good_fft_size(widest(field_rows_, rows_, fft_.rows())));
  part_ = FftBuffer(tile_->floats());
  sum_ = FftBuffer(fft_.floats());
}

// The cells along an axis in which a node has a weight.
BlurGrid::Range BlurGrid::tile_along(int node, int count, int length, int cells) const {
  if (count == 1) return {0, cells};
  const double step_px = (length - 1.0) / (count - 1);
  const auto cell = [&](double px) {
    return oversampling_ * px + 0.5 * (oversampling_ - 1) + half_;
  };
  return {
      node == 0 ? 0 : std::max(0, int(std::floor(cell((node - 1) * step_px)))),
      node == count - 1 ? cells : std::min(cells, int(std::ceil(cell((node + 1) * step_px))) + 1)};
}

void BlurGrid::set_kernels(const std::vector<PsfKernel>& kernels, Threads& threads) {
  if (int(kernels.size()) != field_columns_ * field_rows_) throw Error("blur: number of kernels");
  const RealFft2& fft = tile_ ? *tile_ : fft_;
  FftBuffer& image = tile_ ? part_ : cells_;
  spectra_.resize(kernels.size());
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const PsfKernel& kernel = kernels[i];
    if (kernel.half != half_) throw Error("blur: size of a kernel");
    set_to_zero(image, fft, threads);
    for (int dy = -half_; dy <= half_; ++dy)
      for (int dx = -half_; dx <= half_; ++dx) {
        const int y = (dy + fft.rows()) % fft.rows(), x = (dx + fft.columns()) % fft.columns();
        image.data()[std::size_t(y) * std::size_t(fft.stride()) + std::size_t(x)] =
            kernel.at(dx, dy);
      }
    fft.spectrum(image, threads, spectra_[i]);
  }
  if (kernels.size() > 1 && !part_.data()) {
    part_ = FftBuffer(fft_.floats());
    sum_ = FftBuffer(fft_.floats());
  }
  empty_ = false;
  clear(threads);
}

void BlurGrid::clear(Threads& threads) {
  if (empty_) return;
  set_to_zero(cells_, fft_, threads);
  empty_ = true;
}

DepositView BlurGrid::cells() {
  empty_ = false;
  return {.pixels = cells_.data(),
          .columns = columns_ * oversampling_ + 2 * half_,
          .rows = rows_ * oversampling_ + 2 * half_,
          .stride = fft_.stride(),
          .left = half_,
          .top = half_,
          .frame_columns = columns_ * oversampling_,
          .frame_rows = rows_ * oversampling_};
}

PixelPosition BlurGrid::cell_of(PixelPosition p) const {
  const double k = oversampling_, shift = 0.5 * (k - 1) + half_;
  return {k * p.x_px + shift, k * p.y_px + shift};
}

PixelPosition BlurGrid::pixel_of(PixelPosition c) const {
  const double k = oversampling_, shift = 0.5 * (k - 1) + half_;
  return {(c.x_px - shift) / k, (c.y_px - shift) / k};
}

Arc BlurGrid::on_cells(const Arc& arc) const {
  Arc a = arc;
  a.start = cell_of(arc.start);
  a.middle = cell_of(arc.middle);
  a.end = cell_of(arc.end);
  return a;
}

void BlurGrid::find_lit_rows(Threads& threads) {
  threads.for_ranges(lit_.size(), row_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const float* row = cells_.data() + y * std::size_t(fft_.stride());
      lit_[y] = std::any_of(row, row + fft_.columns(), [](float e) { return e != 0.0f; });
    }
  });
}

// Light near one node of the field, weighted by the linear interpolation.
void BlurGrid::weigh(int node, Threads& threads) {
  const int node_x = node % field_columns_, node_y = node / field_columns_;
  const auto stride = std::size_t(fft_.stride());
  threads.for_ranges(lit_.size(), row_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      if (!lit_[y]) continue;
      const double row = pixel_of({0.0, double(y)}).y_px;
      const float share = hat(node_y, field_rows_, row, rows_);
      const float* in = cells_.data() + y * stride;
      float* out = part_.data() + y * stride;
      for (int x = 0; x < fft_.columns(); ++x)
        out[x] = in[x] == 0.0f
                     ? 0.0f
                     : in[x] * share *
                           hat(node_x, field_columns_, pixel_of({double(x), 0.0}).x_px, columns_);
    }
  });
}

// Blurs the light near one node, weighted as above, on a grid of its own, and adds it to the sum.
void BlurGrid::blur_tile(int node, Threads& threads) {
  const int node_x = node % field_columns_, node_y = node / field_columns_;
  const Range across = tile_along(node_x, field_columns_, columns_, fft_.columns()),
              down = tile_along(node_y, field_rows_, rows_, fft_.rows());
  const auto stride = std::size_t(fft_.stride()), own_stride = std::size_t(tile_->stride());
  std::vector<float> share_of_column;
  for (int x = across.begin; x < across.end; ++x)
    share_of_column.push_back(
        hat(node_x, field_columns_, pixel_of({double(x), 0.0}).x_px, columns_));
  std::vector<char> lit(std::size_t(tile_->rows()));
  threads.for_ranges(
      std::size_t(tile_->rows()), row_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
          const int y = down.begin + int(v) - half_;
          if (y < down.begin || y >= down.end || !lit_[std::size_t(y)]) continue;
          const float share = hat(node_y, field_rows_, pixel_of({0.0, double(y)}).y_px, rows_);
          const float* in = cells_.data() + std::size_t(y) * stride + across.begin;
          float* row = part_.data() + v * own_stride;
          std::fill(row, row + own_stride, 0.0f);
          bool is_lit = false;
          for (std::size_t i = 0; i < share_of_column.size(); ++i) {
            const float light = in[i] * share * share_of_column[i];
            row[std::size_t(half_) + i] = light;
            is_lit = is_lit || light != 0.0f;
          }
          lit[v] = is_lit;
        }
      });
  if (std::none_of(lit.begin(), lit.end(), [](char l) { return l; })) return;
  // Rows and columns of the tile within the frame.
  const auto within = [&](const Range& range, int length) {
    const int begin = std::max(half_, range.begin - half_),
              end = std::min(half_ + length * oversampling_, range.end + half_);
    return Range{begin, std::max(begin, end)};
  };
  const Range rows = within(down, rows_), columns = within(across, columns_);
  const int first = down.begin - half_, left = across.begin - half_;
  tile_->convolve(part_, lit, rows.begin - first, rows.end - first, spectra_[std::size_t(node)],
                  threads);
  threads.for_ranges(std::size_t(rows.end - rows.begin), row_grain,
                     [&](std::size_t begin, std::size_t end) {
                       for (std::size_t r = begin; r < end; ++r) {
                         const auto y = std::size_t(rows.begin) + r;
                         const float* in = part_.data() + (y - std::size_t(first)) * own_stride;
                         float* out = sum_.data() + y * stride;
                         for (int x = columns.begin; x < columns.end; ++x) out[x] += in[x - left];
                       }
                     });
}

FftBuffer& BlurGrid::blur(Threads& threads) {
  const int begin = half_, end = half_ + rows_ * oversampling_;
  if (spectra_.size() == 1) {
    fft_.convolve(cells_, lit_, begin, end, spectra_[0], threads);
    return cells_;
  }
  std::fill(sum_.data(), sum_.data() + sum_.size(), 0.0f);
  if (tile_) {
    for (int node = 0; node < int(spectra_.size()); ++node) blur_tile(node, threads);
    return sum_;
  }
  for (int node = 0; node < int(spectra_.size()); ++node) {
    weigh(node, threads);
    fft_.add_product(part_, lit_, spectra_[std::size_t(node)], sum_, threads);
  }
  fft_.invert(sum_, begin, end, threads);
  return sum_;
}

// Shifts each pixel's light to the start of its first row of cells, and sums what is above and
// below 0.
void BlurGrid::resample(FftBuffer& cells, PointSpread::Resampling resampling, Threads& threads) {
  const int k = oversampling_;
  const auto stride = std::size_t(fft_.stride());
  const ResamplingCells taken = resampling_cells(k, resampling);
  threads.for_ranges(std::size_t(rows_), row_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      float* rows = cells.data() + (std::size_t(half_) + y * std::size_t(k)) * stride;
      const float* frame = rows + half_;
      double bright = 0.0, dark = 0.0;
      for (int x = 0; x < columns_; ++x) {
        float sum = 0.0f;
        for (int j = taken.first; j < taken.first + taken.count; ++j)
          for (int i = taken.first; i < taken.first + taken.count; ++i)
            sum += frame[std::size_t(j) * stride + std::size_t(x * k + i)];
        sum *= taken.scale;
        rows[x] = sum;
        bright += sum > 0.0f ? sum : 0.0f;
        dark += sum > 0.0f ? 0.0f : sum;
      }
      of_row_[y] = {bright, dark};
    }
  });
}

void BlurGrid::add_positive(const FftBuffer& cells, ExpectedElectronImage& light,
                            Threads& threads) const {
  Light total;
  for (const Light& row : of_row_) {
    total.bright += row.bright;
    total.dark += row.dark;
  }
  if (!(total.bright > 0.0)) return;
  const auto scale = float(std::max(0.0, (total.bright + total.dark) / total.bright));
  threads.for_ranges(std::size_t(rows_), row_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const float* in = cells.data() + (std::size_t(half_) + y * std::size_t(oversampling_)) *
                                           std::size_t(fft_.stride());
      float* out = light.row(int(y));
      for (int x = 0; x < columns_; ++x) out[x] += in[x] > 0.0f ? scale * in[x] : 0.0f;
    }
  });
}

void BlurGrid::blur_into(ExpectedElectronImage& light, PointSpread::Resampling resampling,
                         Threads& threads) {
  if (light.columns != columns_ || light.rows != rows_) throw Error("blur: size of the image");
  if (spectra_.empty()) throw Error("blur: no kernel was set");
  find_lit_rows(threads);
  if (std::none_of(lit_.begin(), lit_.end(), [](char lit) { return lit; })) return;
  FftBuffer& blurred = blur(threads);
  resample(blurred, resampling, threads);
  add_positive(blurred, light, threads);
  empty_ = false;
}

}  // namespace dmise
