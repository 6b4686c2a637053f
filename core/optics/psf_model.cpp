#include "core/optics/psf_model.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/optics/projection.h"
#include "core/optics/psf_table.h"

namespace dmise {
namespace {

using Model = PointSpread::Model;

/// Tapers the kernel over its outer half: with a sharp edge, the division by the Gaussian of the
/// deposits would ring. Normalises the sum to 1.
template <class T>
PsfKernel tapered(const std::vector<T>& values, int half) {
  PsfKernel kernel{half, std::vector<float>(values.size())};
  const double inner = 0.5 * half;
  std::vector<double> weighed(values.size());
  double sum = 0.0;
  for (int dy = -half; dy <= half; ++dy)
    for (int dx = -half; dx <= half; ++dx) {
      const double r = std::hypot(dx, dy);
      const double edge = std::clamp((r - inner) / (half + 1.0 - inner), 0.0, 1.0);
      const double c = std::cos(0.5 * pi * edge);
      const auto i = std::size_t((dy + half) * kernel.side() + dx + half);
      sum += weighed[i] = values[i] * c * c;
    }
  for (std::size_t i = 0; i < weighed.size(); ++i) kernel.values[i] = float(weighed[i] / sum);
  return kernel;
}
PsfKernel tapered(const PsfKernel& kernel) { return tapered(kernel.values, kernel.half); }

constexpr std::size_t max_places = 256;  // with cached centring

/// Whether Noll's term is odd about the centre.
bool has_odd_order(int noll) { return noll_orders(noll)[0] % 2 == 1; }

}  // namespace

PsfModel::PsfModel(const Optics& optics, std::vector<WavelengthShare> band, const PsfPlan& plan,
                   const std::optional<SensorSeeing>& seeing, const RngKey& turbulence)
    : optics_(optics),
      band_(std::move(band)),
      plan_(plan),
      cell_rad_(optics.pixel_angle_rad() / plan.oversampling) {
  if (band_.empty()) throw Error("psf: no wavelength");
  if (plan.exposure != ExposureKind::none) seeing_ = seeing;
  grids_ = sample_pupils(optics_, band_, plan_, seeing_);
  extra_.resize(band_.size());
  if (!has_screens(plan_)) return;
  screen_grid_ = sample_screens(optics_, plan_, seeing_);
  flow_ = std::make_shared<FrozenFlow>(
      aperture_samples(pupil_at(optics_, {}, plan_.wavelength_m), screen_grid_),
      seeing_->outer_scale_m / screen_grid_.step_m, turbulence);
}

PsfModel PsfModel::refocused(const Optics& optics, const PsfPlan& plan) const {
  PsfModel other = *this;
  other.optics_ = optics;
  other.plan_ = plan;
  other.cell_rad_ = optics.pixel_angle_rad() / plan.oversampling;
  other.extra_.assign(band_.size(), std::nullopt);
  other.centred_.clear();
  try {
    other.grids_ = sample_pupils(optics, band_, plan, seeing_);
  } catch (const ConfigError&) {
    other.plan_.geometric = true;
    if (has_screens(plan)) other.plan_.exposure = ExposureKind::lasting;
    other.flow_ = nullptr;
    other.grids_.clear();
  }
  return other;
}

// Tilts that put the centroid of the truncated kernel without air on the axis: first by the
// wavefront's mean slope, then by the remaining offset. Tables have their own tilt.
std::array<ZernikeTerm, 2> PsfModel::centring(const FieldPlace& place, std::size_t wavelength) {
  const double wavelength_m = band_[wavelength].wavelength_m;
  Optics centred = optics_;
  centred.spread.varying = {};
  const Pupil own = pupil_at(centred, place, wavelength_m);
  std::array<ZernikeTerm, 2> tilt = centring_tilt(own);
  const bool symmetric = std::none_of(own.wavefront.begin(), own.wavefront.end(),
                                      [](const ZernikeTerm& t) { return has_odd_order(t.noll); });
  if (symmetric && own.spiders % 2 == 0) return tilt;
  // A tilt of a [rad rms] displaces by 2 a lambda / (pi D).
  const double rad_per_cell = 0.5 * pi * own.aperture_m / wavelength_m * cell_rad_;
  constexpr double near_enough_cells = 1e-3;  // a step leaves a hundredth of the offset
  for (int i = 0; i < 3; ++i) {
    Pupil p = own;
    p.wavefront.insert(p.wavefront.end(), tilt.begin(), tilt.end());
    const PsfKernel k =
        tapered(pupil_kernel(p, grids_[wavelength], plan_.half_cells, {}, extra_at(wavelength)));
    double x = 0.0, y = 0.0;
    for (int dy = -k.half; dy <= k.half; ++dy)
      for (int dx = -k.half; dx <= k.half; ++dx) {
        x += double(k.at(dx, dy)) * dx;
        y += double(k.at(dx, dy)) * dy;
      }
    tilt[0].rms_rad -= rad_per_cell * x;
    tilt[1].rms_rad -= rad_per_cell * y;
    if (std::hypot(x, y) < near_enough_cells) break;
  }
  return tilt;
}

bool PsfModel::is_round(const FieldPlace& place) const {
  const PointSpread& s = optics_.spread;
  return s.model == Model::gaussian || plan_.geometric ||
         (!flow_ && s.spiders == 0 && s.wavefront.empty() && s.defocus_m == 0.0 &&
          s.varying.wavefront.empty() && (place.radius == 0.0 || !s.field.any()));
}

void PsfModel::set_defocus(double defocus_m) {
  if (optics_.spread.defocus_m == defocus_m) return;
  optics_.spread.defocus_m = defocus_m;
  centred_.clear();
}

// By geometrical optics light is even over the disc, or over the ring of an obscured pupil.
double PsfModel::disc_otf(double nu) const {
  if (optics_.spread.defocus_m == 0.0) return 1.0;
  const double disc_rad =
      std::abs(optics_.spread.defocus_m) / optics_.f_number() / optics_.focal_length_m;
  const double e = optics_.obscuration;
  return (defocus_otf(nu, disc_rad) - e * e * defocus_otf(nu, e * disc_rad)) / (1 - e * e);
}

PsfKernel PsfModel::gaussian_kernel(const FieldPlace& place, double wavelength_m) {
  const GaussianShape shape = gaussian_at(optics_, place, wavelength_m);
  const double pixel_rad = optics_.pixel_angle_rad(), scale = 2 * pi * pi * pixel_rad * pixel_rad;
  const auto otf = [&](double nu_x, double nu_y) {
    const double square =
        shape.xx * nu_x * nu_x + 2 * shape.xy * nu_x * nu_y + shape.yy * nu_y * nu_y;
    const double extra = extra_otf(nu_x, nu_y, wavelength_m);
    if (extra == 0.0) return 0.0;
    return std::exp(-scale * square) * disc_otf(std::hypot(nu_x, nu_y)) * extra;
  };
  return signed_kernel_of(otf, OtfSymmetry::point, 0.5 / cell_rad_, cell_rad_, plan_.half_cells);
}

PsfKernel PsfModel::file_kernel(const FieldPlace& place, double wavelength_m) const {
  const MeasuredPsf& measured = *optics_.spread.measured;
  const PixelPosition axis = principal_point(optics_);
  const double height_px = place.radius * corner_px(optics_);
  const PixelPosition at{axis.x_px + height_px * std::cos(place.angle_rad),
                         axis.y_px + height_px * std::sin(place.angle_rad)};
  const double pixel_rad = optics_.pixel_angle_rad();
  const auto more = [&](double x_per_px, double y_per_px) {
    const double nu_x = x_per_px / pixel_rad, nu_y = y_per_px / pixel_rad;
    const double extra = disc_otf(std::hypot(nu_x, nu_y)) * extra_otf(nu_x, nu_y, wavelength_m);
    return measured.with_pixel() ? extra / (pixel_otf(nu_x, pixel_rad) * pixel_otf(nu_y, pixel_rad))
                                 : extra;
  };
  return measured.kernel(at, wavelength_m, plan_.oversampling, plan_.half_cells, more);
}

double PsfModel::air_otf(double nu, double wavelength_m) const {
  if (plan_.exposure != ExposureKind::lasting) return 1.0;
  return std::exp(-0.5 * von_karman_structure(nu * wavelength_m, seeing_->r0_at_m(wavelength_m),
                                              seeing_->outer_scale_m));
}

double PsfModel::extra_otf(double nu_x, double nu_y, double wavelength_m) const {
  // The grid holds no frequency above half a cycle per cell.
  if (std::max(std::abs(nu_x), std::abs(nu_y)) * cell_rad_ > 0.5 + 1e-9) return 0.0;
  const double nu = std::hypot(nu_x, nu_y);
  double h = jitter_otf(nu, optics_.spread.jitter_rad) * air_otf(nu, wavelength_m) /
             jitter_otf(nu, grid_sigma_cells * cell_rad_);
  if (optics_.spread.resampling == PointSpread::Resampling::bilinear) {
    const double pixel_rad = cell_rad_ * plan_.oversampling;
    for (const double axis : {nu_x, nu_y})
      h *= pixel_otf(axis, pixel_rad) / pixel_otf(axis, cell_rad_);
  }
  return h;
}

const SampledOtf& PsfModel::extra_at(std::size_t wavelength) {
  auto& sampled = extra_[wavelength];
  if (!sampled)
    sampled.emplace(grids_[wavelength], [&](double nu_x, double nu_y) {
      return extra_otf(nu_x, nu_y, band_[wavelength].wavelength_m);
    });
  return *sampled;
}

PsfKernel PsfModel::round_kernel(double wavelength_m) {
  const bool gaussian = optics_.spread.model == Model::gaussian;
  const double sigma_rad = psf_sigma_px(optics_, wavelength_m) * optics_.pixel_angle_rad();
  const auto otf = [&](double nu_x, double nu_y) {
    const double nu = std::hypot(nu_x, nu_y);
    const double blur =
        gaussian ? jitter_otf(nu, sigma_rad)
                 : diffraction_otf(nu, wavelength_m, optics_.aperture_m, optics_.obscuration);
    return blur == 0.0 ? 0.0 : blur * disc_otf(nu) * extra_otf(nu_x, nu_y, wavelength_m);
  };
  return signed_kernel_of(otf, OtfSymmetry::axes, 0.5 / cell_rad_, cell_rad_, plan_.half_cells);
}

PsfKernel PsfModel::pupil_kernel_at(const FieldPlace& place, std::size_t wavelength,
                                    const PhaseScreen* screen) {
  const double wavelength_m = band_[wavelength].wavelength_m;
  const auto known = std::find_if(centred_.begin(), centred_.end(), [&](const Centred& c) {
    return c.place == place && c.wavelength == wavelength;
  });
  const std::array<ZernikeTerm, 2> tilt =
      known != centred_.end() ? known->tilt : centring(place, wavelength);
  if (known == centred_.end() && centred_.size() < max_places)
    centred_.push_back({place, wavelength, tilt});
  Pupil p = pupil_at(optics_, place, wavelength_m);
  p.wavefront.insert(p.wavefront.end(), tilt.begin(), tilt.end());
  const ScreenAhead ahead{screen, screen_grid_.step_m, plan_.wavelength_m / wavelength_m};
  return pupil_kernel(p, grids_[wavelength], plan_.half_cells, ahead, extra_at(wavelength));
}

PsfKernel PsfModel::kernel(const FieldPlace& place, double start_s, double exposure_s) {
  const auto side = std::size_t(2 * plan_.half_cells + 1);
  std::vector<double> sum(side * side);
  const auto add = [&](const PsfKernel& k, double share) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += share * double(k.values[i]);
  };
  if (optics_.spread.model == Model::file) {
    for (const WavelengthShare& w : band_) add(file_kernel(place, w.wavelength_m), w.share);
    PsfKernel kernel{plan_.half_cells, std::vector<float>(sum.size())};
    std::ranges::transform(sum, kernel.values.begin(), [](double v) { return float(v); });
    return kernel;
  }
  if (optics_.spread.model == Model::gaussian &&
      (optics_.spread.varying.any() || optics_.spread.drift.any())) {
    for (const WavelengthShare& w : band_) add(gaussian_kernel(place, w.wavelength_m), w.share);
  } else if (is_round(place)) {
    for (const WavelengthShare& w : band_) add(round_kernel(w.wavelength_m), w.share);
  } else if (!flow_) {
    for (std::size_t w = 0; w < band_.size(); ++w)
      add(pupil_kernel_at(place, w, nullptr), band_[w].share);
  } else {
    const double r0_samples = seeing_->r0_at_m(plan_.wavelength_m) / screen_grid_.step_m;
    for (int i = 0; i < plan_.screens; ++i) {
      const double t = start_s + exposure_s * (i + 0.5) / plan_.screens;
      const PhaseScreen screen = flow_->at(seeing_->wind_m_per_s * t / screen_grid_.step_m,
                                           seeing_->wind_direction_deg * deg, r0_samples);
      for (std::size_t w = 0; w < band_.size(); ++w)
        add(pupil_kernel_at(place, w, &screen), band_[w].share / plan_.screens);
    }
  }
  return tapered(sum, plan_.half_cells);
}

}  // namespace dmise
