#include "core/detection/light/psf.h"

#include <algorithm>

#include "core/base/units.h"

namespace dmise {

double with_pixel(double sigma_px) { return std::sqrt(sigma_px * sigma_px + pixel_variance_px2); }

double sigma_with_pixel(double fwhm_px) { return with_pixel(fwhm_px / fwhm_per_sigma); }

double fwhm_before_pixel(double sigma_px) {
  return fwhm_per_sigma * std::sqrt(std::max(sigma_px * sigma_px - pixel_variance_px2, 0.0));
}

double Psf::equivalent_sigma_px() const {
  const double e2 = along_x * along_x + along_diagonal * along_diagonal;
  if (count == 1 && e2 == 0.0) return parts[0].sigma_px;
  double squares = 0.0;  // times 4 pi
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) {
      const Part &a = parts[i], &b = parts[j];
      const double sum = a.sigma_px * a.sigma_px + b.sigma_px * b.sigma_px;
      const double optical = sum - 2 * pixel_variance_px2;
      squares += 2 * a.weight * b.weight / std::sqrt(sum * sum - e2 * optical * optical);
    }
  return 1 / std::sqrt(squares);
}

PsfField PsfField::gaussian(double fwhm_px) {
  PsfField field;
  field.width_px = fwhm_px / fwhm_per_sigma;
  return field;
}

double PsfField::scale(PixelPosition at) const {
  if (!varies) return 1.0;
  const PixelPosition p = unit(at);
  const Polynomial by = powers(p.x_px, p.y_px);
  double sum = 0.0;
  for (std::size_t i = 0; i < terms; ++i) sum += log_scale[i] * by[i];
  return std::exp(std::clamp(sum, min_log_scale, max_log_scale));
}

double PsfField::sigma_at(PixelPosition at) const { return with_pixel(width_px * scale(at)); }

Psf PsfField::at(PixelPosition at) const {
  const double width = width_px * scale(at);
  Psf psf;
  psf.count = count;
  psf.along_x = along_x;
  psf.along_diagonal = along_diagonal;
  for (std::size_t i = 0; i < count; ++i)
    psf.parts[i] = {weights[i], with_pixel(ratios[i] * width)};
  return psf;
}

}  // namespace dmise
