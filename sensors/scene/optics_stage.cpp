#include "sensors/scene/optics_stage.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/config/sensors/band_wavelengths.h"
#include "core/effects/frame_effects.h"
#include "core/optics/projection.h"
#include "sensors/scene/bodies_in_field.h"

namespace dmise {
namespace {

using Method = PointSpread::Method;

PsfPlan plan_of(const SensorConfig& sensor) {
  const Camera& camera = sensor.camera;
  if (sensor.effects.has(PointSpread::facts))
    return plan_psf(camera.optics, camera.band.centre_m, sensor.seeing, sensor.exposure_s,
                    AirTurbulence::level(sensor.effects));
  return {};
}

/// The optics with those effects of them that are on. Kernels reach as far as without.
Optics acting_blur(const SensorConfig& sensor) {
  Optics optics = sensor.camera.optics;
  PointSpread& s = optics.spread;
  if (!s.varying.any()) return optics;
  const int places = FieldBlur::places[std::size_t(sensor.effects.level(FieldBlur::facts))];
  s.grid_columns = optics.columns > 1 ? places : 1;
  s.grid_rows = optics.rows > 1 ? places : 1;
  return optics;
}

/// Places of the kernels over the field, row by row.
std::vector<FieldPlace> field_places(const Optics& o) {
  const PointSpread& s = o.spread;
  const auto along = [](int i, int count, int length) {
    return count == 1 ? 0.5 * (length - 1) : i * (length - 1.0) / (count - 1);
  };
  std::vector<FieldPlace> places;
  for (int j = 0; j < s.grid_rows; ++j)
    for (int i = 0; i < s.grid_columns; ++i)
      places.push_back(
          field_place(o, {along(i, s.grid_columns, o.columns), along(j, s.grid_rows, o.rows)}));
  return places;
}

}  // namespace

OpticsStage::OpticsStage(const SensorConfig& sensor, std::uint64_t seed, Threads& threads)
    : optics_(acting_blur(sensor)),
      blurs_(sensor.effects.has(PointSpread::facts)),
      border_px_(acting_detector(sensor.camera.detector, sensor.effects).reference_px),
      drifts_(sensor.camera.optics.spread.drift.any() && sensor.effects.has(FocusDrift::facts)),
      defocus_m_(optics_.spread.defocus_m),
      plan_(plan_of(sensor)),
      threads_(threads) {
  const Band& band = sensor.camera.band;
  optics_.spread.wavelengths =
      std::max(optics_.spread.wavelengths,
               PsfWavelengths::count[std::size_t(sensor.effects.level(PsfWavelengths::facts))]);
  if (blurs_) scale_.emplace(optics_, plan_);
  if (plan_.method == Method::deposit) {
    const double sigma_px = !blurs_ ? 0.0
                            : optics_.spread.model == PointSpread::Model::gaussian
                                ? psf_sigma_px(optics_, band.centre_m)
                                : plan_.fwhm_px / fwhm_per_sigma;
    table_ = make_psf_table(sigma_px);
    plan_.fwhm_px = table_.sigma_px * fwhm_per_sigma;
    return;
  }
  table_ = make_psf_table(grid_sigma_cells);
  model_ =
      std::make_unique<PsfModel>(optics_, wavelengths_of(band, optics_.spread.wavelengths), plan_,
                                 sensor.seeing, rng_key(seed, sensor.name, 0, "turbulence"));
  direct_ = std::make_unique<DirectBlur>(plan_.oversampling, plan_.half_cells,
                                         optics_.spread.resampling, border_px_);
  if (plan_.method == Method::transform)
    grid_ = std::make_unique<BlurGrid>(optics_.columns, optics_.rows, plan_.oversampling,
                                       plan_.half_cells, optics_.spread.grid_columns,
                                       optics_.spread.grid_rows, optics_.spread.varying.any());
}

double OpticsStage::fwhm_px() const {
  if (!model_ || defocus_m_ == optics_.spread.defocus_m) return plan_.fwhm_px;
  const auto square_px = [&](double defocus_m) {
    const double disc_px = defocus_m / optics_.f_number() / optics_.pixel_pitch_m;
    return disc_px * disc_px;
  };
  return std::sqrt(std::max(0.0, plan_.fwhm_px * plan_.fwhm_px + square_px(defocus_m_) -
                                     square_px(optics_.spread.defocus_m)));
}

/// Whether that changes the kernels.
bool OpticsStage::set_defocus(double time_s) {
  if (!drifts_) return false;
  const double before_m = defocus_m_;
  defocus_m_ = optics_.spread.defocus_m + optics_.spread.drift.at_m(time_s);
  model_->set_defocus(defocus_m_);
  return defocus_m_ != before_m;
}

void OpticsStage::make_kernels() {
  std::vector<PsfKernel> kernels;
  if (grid_) {
    for (const FieldPlace& place : field_places(optics_))
      kernels.push_back(model_->kernel(place, exposure_start_s_, exposure_s_));
    grid_->set_kernels(kernels, threads_);
  }
  central_ = kernels.size() == 1 ? std::move(kernels[0])
                                 : model_->kernel({}, exposure_start_s_, exposure_s_);
  direct_ready_ = false;
  has_kernels_ = true;
}

std::vector<Deposited> OpticsStage::sum_directly(std::span<const Arc> arcs,
                                                 ExpectedElectronImage& light) {
  if (optics_.spread.grid_columns * optics_.spread.grid_rows == 1) {
    if (!direct_ready_) direct_->set_kernel(central_);
    direct_ready_ = true;
    return direct_->deposit(arcs, light, threads_);
  }
  // Each with the kernel of its own place.
  std::vector<Deposited> result;
  for (const Arc& arc : arcs) {
    direct_->set_kernel(
        model_->kernel(field_place(optics_, arc.middle), exposure_start_s_, exposure_s_));
    result.push_back(direct_->deposit({&arc, 1}, light, threads_)[0]);
  }
  return result;
}

void OpticsStage::begin(const FrameTimes& exposure, double limit_e) {
  limit_e_ = limit_e;
  exposure_start_s_ = exposure.start.seconds();
  exposure_s_ = exposure.seconds();
  if (out_of_focus_) out_of_focus_->begin(exposure_start_s_, exposure_s_);
  if (!model_) return;
  bright_e_ = bright_ratio * limit_e;
  const bool refocused = set_defocus(exposure.middle.seconds());
  if (!has_kernels_ || refocused || model_->changes()) make_kernels();
  if (grid_) grid_->clear(threads_);
}

std::vector<Deposited> OpticsStage::put(std::span<const Arc> arcs, const DepositView& view,
                                        DepositSums sums) {
  if (!evaluator_) return deposit(arcs, table_, view, threads_, best_simd_level(), sums);
  std::vector<Arc> points, moving;
  for (const Arc& arc : arcs) (arc.is_point() ? points : moving).push_back(arc);
  const auto drawn = evaluator_->add(points, table_, view, threads_);
  const auto swept = deposit(moving, table_, view, threads_);
  std::vector<Deposited> result;
  auto point = drawn.begin(), sweep = swept.begin();
  for (const Arc& arc : arcs) result.push_back(arc.is_point() ? *point++ : *sweep++);
  return result;
}

std::vector<Deposited> OpticsStage::add(std::span<const Arc> arcs, ExpectedElectronImage& light,
                                        DepositSums sums) {
  if (!model_) return put(arcs, without_border(view_of(light), border_px_), sums);
  if (!grid_) return sum_directly(arcs, light);

  const auto is_bright = [&](const Arc& arc) { return arc.signal_e > bright_e_; };
  std::vector<Arc> bright, others;
  for (const Arc& arc : arcs) (is_bright(arc) ? bright : others).push_back(arc);
  for (Arc& arc : others) arc = grid_->on_cells(arc);
  std::vector<Deposited> direct, on_grid;
  if (!bright.empty()) direct = sum_directly(bright, light);
  if (!others.empty())
    on_grid = put(others, without_border(grid_->cells(), border_px_ * grid_->oversampling()), sums);
  std::vector<Deposited> result;
  std::size_t b = 0, o = 0;
  for (const Arc& arc : arcs) {
    if (is_bright(arc)) {
      result.push_back(direct[b++]);
      continue;
    }
    Deposited d = on_grid[o++];
    if (d.signal_e > 0.0) {
      const PixelPosition at = grid_->pixel_of({d.x_px, d.y_px});
      d = {d.signal_e, at.x_px, at.y_px};
    }
    result.push_back(d);
  }
  return result;
}

double OpticsStage::defocus_at_m(double range_m, int level) const {
  if (level == 0 || !scale_) return defocus_m_;
  return scale_->stepped_m(defocus_m_ - range_defocus_m(optics_, range_m), defocus_m_,
                           RangeDefocus::misplaced[std::size_t(level)]);
}

double OpticsStage::disc_px(double defocus_m) const {
  return defocus_m == defocus_m_ ? 0.0 : std::abs(scale_->disc_px(defocus_m));
}

DefocusBlur& OpticsStage::out_of_focus() {
  if (!out_of_focus_) {
    out_of_focus_ = std::make_unique<DefocusBlur>(optics_, plan_, model_.get(), border_px_);
    out_of_focus_->begin(exposure_start_s_, exposure_s_);
  }
  return *out_of_focus_;
}

double OpticsStage::reach_px(double defocus_m) {
  if (defocus_m != defocus_m_) return out_of_focus().reach_px(defocus_m);
  return plan_.method == Method::deposit ? 4.0 * plan_.fwhm_px + 2.0
                                         : double(plan_.half_cells) / plan_.oversampling + 2.0;
}

Deposited OpticsStage::add(std::span<const Arc> arcs, double defocus_m,
                           ExpectedElectronImage& light) {
  if (defocus_m != defocus_m_) return out_of_focus().deposit(arcs, defocus_m, light, threads_);
  Deposited sum;
  for (const Deposited& part : add(arcs, light)) sum = sum + part;
  return sum;
}

int OpticsStage::reach_px() const {
  const int reach = grid_ ? plan_.half_cells / plan_.oversampling + 1
                          : gaussian_reach_px(plan_.fwhm_px / fwhm_per_sigma) + 1;
  return std::min(reach, disc_margin_px);
}

void OpticsStage::add_extended(const ExtendedLight& source, ExpectedElectronImage& light) {
  if (!grid_) {
    add_by_gaussian(source, plan_.fwhm_px / fwhm_per_sigma, light, threads_);
    return;
  }
  lay_on(source, *grid_, threads_);
  grid_->blur_into(light, optics_.spread.resampling, threads_);
  grid_->clear(threads_);
}

void OpticsStage::finish(ExpectedElectronImage& light) {
  if (!model_) return;
  if (grid_) grid_->blur_into(light, optics_.spread.resampling, threads_);
  threads_.for_ranges(light.pixels.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      light.pixels[i] = light.pixels[i] < 0.0f ? 0.0f : light.pixels[i];
  });
}

}  // namespace dmise
