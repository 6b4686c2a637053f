#include "core/optics/blur/defocus_blur.h"

#include <algorithm>
#include <cmath>

#include "core/optics/projection.h"

namespace dmise {
namespace {

constexpr std::size_t max_kept_cells = 16 << 20;
constexpr int places_along = 9;

ArcExtent hull(std::span<const Arc> arcs) {
  ArcExtent all = extent(arcs.front());
  for (const Arc& arc : arcs) {
    const ArcExtent e = extent(arc);
    all = {std::min(all.left, e.left), std::min(all.top, e.top), std::max(all.right, e.right),
           std::max(all.bottom, e.bottom)};
  }
  return all;
}

/// The part of a frame within `reach_px` of a rectangle, in whole pixels; may be empty.
ArcExtent around(const ArcExtent& e, int reach_px, int columns, int rows) {
  return {std::max(0.0, std::floor(e.left) - reach_px), std::max(0.0, std::floor(e.top) - reach_px),
          std::min(columns - 1.0, std::ceil(e.right) + reach_px),
          std::min(rows - 1.0, std::ceil(e.bottom) + reach_px)};
}

int tile_side_px(int reach_px) { return 2 * reach_px + 2 + reach_px / 2; }

}  // namespace

DefocusBlur::DefocusBlur(const Optics& optics, const PsfPlan& in_focus_plan,
                         const PsfModel* in_focus, int border_px)
    : optics_(blurred_by(in_focus_plan, optics)),
      in_focus_plan_(in_focus_plan),
      in_focus_(in_focus),
      border_px_(border_px),
      table_(make_psf_table(grid_sigma_cells)) {
  optics_.spread.drift = {};
  if (in_focus_) return;
  const std::vector<WavelengthShare> centre{{in_focus_plan_.wavelength_m, 1.0}};
  own_ = std::make_unique<PsfModel>(optics_, centre, plan_of(0.0), std::nullopt, RngKey{});
  in_focus_ = own_.get();
}

void DefocusBlur::begin(double start_s, double exposure_s) {
  start_s_ = start_s;
  exposure_s_ = exposure_s;
  if (!in_focus_->changes()) return;
  kernels_.clear();
  grid_.reset();
}

PsfPlan DefocusBlur::plan_of(double defocus_m) const {
  const double disc_px = std::abs(defocus_m) / optics_.f_number() / optics_.pixel_pitch_m;
  return plan_defocused(optics_, in_focus_plan_.wavelength_m, in_focus_plan_, disc_px);
}

int DefocusBlur::reach_px(double defocus_m) const {
  const PsfPlan plan = plan_of(defocus_m);
  return (plan.half_cells + table_.size / 2) / plan.oversampling + 2;
}

FieldPlace DefocusBlur::place_near(PixelPosition at) const {
  const PointSpread& s = optics_.spread;
  if (s.grid_columns * s.grid_rows == 1 && !s.varying.any()) return {};
  const auto nearest = [](double px, int length) {
    const double step_px = (length - 1.0) / (places_along - 1);
    return length == 1 ? 0.0 : step_px * std::round(std::clamp(px, 0.0, length - 1.0) / step_px);
  };
  return field_place(optics_, {nearest(at.x_px, optics_.columns), nearest(at.y_px, optics_.rows)});
}

void DefocusBlur::take_kernel(double defocus_m, const FieldPlace& place, Threads& threads) {
  const Key key{defocus_m, place.radius, place.angle_rad};
  if (grid_ && key == of_grid_) return;
  if (!kernels_.contains(key)) {
    const PsfPlan plan = plan_of(defocus_m);
    const auto side = std::size_t(2 * plan.half_cells + 1);
    std::size_t kept = side * side;
    for (const auto& [other, made] : kernels_) kept += made.kernel.values.size();
    if (kept > max_kept_cells) kernels_.clear();
    Optics optics = optics_;
    optics.spread.defocus_m = defocus_m;
    PsfModel model = in_focus_->refocused(optics, plan);
    kernels_[key] = {plan, model.kernel(place, start_s_, exposure_s_)};
  }
  const auto& [plan, kernel] = kernels_.at(key);
  const int side_px = tile_side_px(reach_px(defocus_m));
  if (!grid_ || grid_->oversampling() != plan.oversampling ||
      grid_->half_cells() != plan.half_cells) {
    grid_ = std::make_unique<BlurGrid>(side_px, side_px, plan.oversampling, plan.half_cells);
    tile_ = ExpectedElectronImage(side_px, side_px);
  }
  grid_->set_kernels({kernel}, threads);
  of_grid_ = key;
}

Deposited DefocusBlur::add_tile(std::span<const Arc> arcs, int left, int top, ArcExtent part,
                                ExpectedElectronImage& light, Threads& threads) {
  const double reach_px = double(grid_->half_cells() + table_.size) / grid_->oversampling() + 1.0;
  const ArcExtent seen{left - reach_px, top - reach_px, left + tile_.columns + reach_px,
                       top + tile_.rows + reach_px};
  std::vector<Arc> near;
  for (const Arc& arc : arcs) {
    if (!extent(arc).meets(seen)) continue;
    Arc moved = arc;
    for (PixelPosition* at : {&moved.start, &moved.middle, &moved.end})
      *at = *at - PixelPosition{double(left), double(top)};
    near.push_back(grid_->on_cells(moved));
  }
  if (near.empty()) return {};
  grid_->clear(threads);
  dmise::deposit(near, table_, grid_->cells(), threads, best_simd_level(), DepositSums::cut);
  std::ranges::fill(tile_.pixels, 0.0f);
  grid_->blur_into(tile_, optics_.spread.resampling, threads);
  // Light of pixels within the frame's border is no signal.
  double sum = 0.0, x_sum = 0.0, y_sum = 0.0;
  const int x_end = std::min(left + tile_.columns, int(part.right) + 1);
  const int y_end = std::min(top + tile_.rows, int(part.bottom) + 1);
  for (int y = top; y < y_end; ++y) {
    const float* in = tile_.row(y - top) - left;
    float* out = light.row(y);
    for (int x = left; x < x_end; ++x) out[x] += in[x];
    if (y < border_px_ || y >= light.rows - border_px_) continue;
    for (int x = std::max(left, border_px_); x < std::min(x_end, light.columns - border_px_); ++x) {
      sum += double(in[x]);
      x_sum += double(in[x]) * x;
      y_sum += double(in[x]) * y;
    }
  }
  return sum > 0.0 ? Deposited{sum, x_sum / sum, y_sum / sum} : Deposited{};
}

Deposited DefocusBlur::deposit(std::span<const Arc> arcs, double defocus_m,
                               ExpectedElectronImage& light, Threads& threads) {
  Deposited sum;
  if (arcs.empty()) return sum;
  const ArcExtent path = hull(arcs);
  const ArcExtent part = around(path, reach_px(defocus_m), light.columns, light.rows);
  if (!(part.left <= part.right && part.top <= part.bottom)) return sum;
  take_kernel(defocus_m,
              place_near({0.5 * (path.left + path.right), 0.5 * (path.top + path.bottom)}),
              threads);
  for (int top = int(part.top); top <= int(part.bottom); top += tile_.rows)
    for (int left = int(part.left); left <= int(part.right); left += tile_.columns)
      sum = sum + add_tile(arcs, left, top, part, light, threads);
  return sum;
}

}  // namespace dmise
