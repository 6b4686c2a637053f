#include "core/optics/blur/direct_blur.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/optics/blur/resample.h"
#include "core/optics/psf_plan.h"

namespace dmise {
namespace {

constexpr int band_rows = 128;
constexpr double piece_px = 16.0;

double size_of(const ArcExtent& e) { return std::max(e.right - e.left, e.bottom - e.top); }

int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

}  // namespace

DirectBlur::DirectBlur(int oversampling, int half_cells, PointSpread::Resampling resampling,
                       int border_px)
    : k_(oversampling),
      half_(half_cells),
      reach_px_((half_cells + oversampling - 1) / oversampling + 1),
      side_(2 * reach_px_ + 1),
      border_px_(border_px),
      resampling_(resampling),
      table_(make_psf_table(grid_sigma_cells)) {}

// shares_[phase][dy][dx]: light that a cell of that phase within its pixel gives to the pixel (dx,
// dy) away.
void DirectBlur::set_kernel(const PsfKernel& kernel) {
  if (kernel.half != half_) throw Error("blur: size of the kernel");
  const auto each = std::size_t(side_) * std::size_t(side_);
  shares_.assign(each * std::size_t(k_ * k_), 0.0f);
  const ResamplingCells taken = resampling_cells(k_, resampling_);
  for (int phase = 0; phase < k_ * k_; ++phase) {
    float* share = shares_.data() + std::size_t(phase) * each;
    for (int dy = -reach_px_; dy <= reach_px_; ++dy)
      for (int dx = -reach_px_; dx <= reach_px_; ++dx) {
        double sum = 0.0;
        for (int j = taken.first; j < taken.first + taken.count; ++j)
          for (int i = taken.first; i < taken.first + taken.count; ++i) {
            const int v = dy * k_ + j - phase / k_, u = dx * k_ + i - phase % k_;
            if (std::abs(u) <= half_ && std::abs(v) <= half_) sum += kernel.at(u, v);
          }
        share[std::size_t((dy + reach_px_) * side_ + dx + reach_px_)] = float(taken.scale * sum);
      }
  }
}

Arc DirectBlur::on_cells(const Arc& arc) const {
  const auto cell = [&](PixelPosition p) {
    return PixelPosition{k_ * p.x_px + 0.5 * (k_ - 1), k_ * p.y_px + 0.5 * (k_ - 1)};
  };
  Arc a = arc;
  a.start = cell(arc.start);
  a.middle = cell(arc.middle);
  a.end = cell(arc.end);
  return a;
}

// Calls use(piece) for short pieces of the arc that meet `reach`, in the order of time.
template <class Use>
void DirectBlur::for_pieces(const Arc& arc, const ArcExtent& reach, const Use& use) const {
  const auto visit = [&](const auto& self, double begin, double end, int depth) -> void {
    const Arc piece = part_of(arc, begin, end);
    const ArcExtent e = extent(piece);
    if (!e.meets(reach)) return;
    if (size_of(e) <= piece_px || depth > 60) return use(piece);
    const double middle = 0.5 * (begin + end);
    self(self, begin, middle, depth + 1);
    self(self, middle, end, depth + 1);
  };
  visit(visit, 0.0, 1.0, 0);
}

void DirectBlur::add(const Arc& piece, int row_begin, int row_end,
                     ExpectedElectronImage& light) const {
  // The piece on its own cells, starting at the first cell of a pixel.
  Arc arc = on_cells(piece);
  const ArcExtent e = extent(arc);
  const int margin = table_.size / 2 + 1;
  const int left_px = floor_div(int(std::floor(e.left)) - margin, k_),
            top_px = floor_div(int(std::floor(e.top)) - margin, k_);
  const int columns = int(std::ceil(e.right)) + margin + 1 - left_px * k_,
            rows = int(std::ceil(e.bottom)) + margin + 1 - top_px * k_;
  const PixelPosition origin{double(left_px * k_), double(top_px * k_)};
  arc.start = arc.start - origin;
  arc.middle = arc.middle - origin;
  arc.end = arc.end - origin;
  thread_local std::vector<float> patch;
  patch.assign(std::size_t(columns) * std::size_t(rows), 0.0f);
  thread_local Threads alone(1);
  dmise::deposit(std::span(&arc, 1), table_, DepositView{patch.data(), columns, rows, columns},
                 alone);

  // Summed in double precision: a pixel is the sum of a thousand small parts.
  const int x_begin = std::max(0, left_px - reach_px_),
            x_end = std::min(light.columns, left_px + (columns - 1) / k_ + reach_px_ + 1);
  const int y_begin = std::max(row_begin, top_px - reach_px_),
            y_end = std::min(row_end, top_px + (rows - 1) / k_ + reach_px_ + 1);
  if (x_begin >= x_end || y_begin >= y_end) return;
  const auto width = std::size_t(x_end - x_begin);
  thread_local std::vector<double> sums;
  sums.assign(width * std::size_t(y_end - y_begin), 0.0);
  const auto each = std::size_t(side_) * std::size_t(side_);
  for (int v = 0; v < rows; ++v)
    for (int u = 0; u < columns; ++u) {
      const double e_here = patch[std::size_t(v) * std::size_t(columns) + std::size_t(u)];
      if (e_here == 0.0) continue;
      const int x0 = left_px + u / k_ - reach_px_, y0 = top_px + v / k_ - reach_px_;
      const float* share = shares_.data() + std::size_t(v % k_ * k_ + u % k_) * each;
      const int i0 = std::max(0, x_begin - x0), i1 = std::min(side_, x_end - x0);
      const int j0 = std::max(0, y_begin - y0), j1 = std::min(side_, y_end - y0);
      for (int j = j0; j < j1; ++j) {
        double* out = sums.data() + std::ptrdiff_t(width) * (y0 + j - y_begin) + (x0 - x_begin);
        const float* in = share + j * side_;
        for (int i = i0; i < i1; ++i) out[i] += e_here * in[i];
      }
    }
  for (int y = y_begin; y < y_end; ++y) {
    const double* in = sums.data() + width * std::size_t(y - y_begin);
    float* out = light.row(y) + x_begin;
    for (std::size_t x = 0; x < width; ++x) out[x] = float(out[x] + in[x]);
  }
}

std::vector<Deposited> DirectBlur::deposit(std::span<const Arc> arcs, ExpectedElectronImage& light,
                                           Threads& threads) {
  if (shares_.empty()) throw Error("blur: no kernel was set");
  const double reach = reach_px_ + double(table_.size) / k_ + 1.0;
  const auto bands = std::size_t((light.rows + band_rows - 1) / band_rows);
  threads.for_ranges(bands, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const int first = int(b) * band_rows, last = std::min(light.rows, first + band_rows);
      const ArcExtent near{-reach, first - reach, light.columns + reach, last + reach};
      for (const Arc& arc : arcs) {
        if (!extent(arc).meets(near)) continue;
        for_pieces(arc, near, [&](const Arc& piece) { add(piece, first, last, light); });
      }
    }
  });
  std::vector<Deposited> result(arcs.size());
  const DepositView frame = without_border({.columns = light.columns * k_,
                                            .rows = light.rows * k_,
                                            .frame_columns = light.columns * k_,
                                            .frame_rows = light.rows * k_},
                                           border_px_ * k_);
  threads.for_ranges(arcs.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Deposited d = deposited_in_frame(on_cells(arcs[i]), table_, frame);
      if (d.signal_e > 0.0) {
        d.x_px = (d.x_px - 0.5 * (k_ - 1)) / k_;
        d.y_px = (d.y_px - 0.5 * (k_ - 1)) / k_;
      }
      result[i] = d;
    }
  });
  return result;
}

}  // namespace dmise
