#include "core/wcs/wcs_refraction.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double slope_over_rad = 0.01 * deg;
constexpr double lowest_smooth_rad = -3 * deg;  // end of the smooth extension below the horizon

const WcsRefraction& required(const Wcs& wcs) {
  if (!wcs.refraction) throw Error("the WCS has no refraction");
  return *wcs.refraction;
}

}  // namespace

RefractionShift::RefractionShift(const Wcs& wcs)
    : lens_(required(wcs).lens.value_or(wcs.projection)),
      principal_point_{wcs.crpix_x, wcs.crpix_y},
      offset_px_{required(wcs).offset_x_px, required(wcs).offset_y_px},
      focal_length_px_(required(wcs).focal_length_px),
      zenith_(required(wcs).zenith),
      refraction_({.pressure_hpa = wcs.refraction->pressure_hpa,
                   .temperature_c = wcs.refraction->temperature_c,
                   .humidity = wcs.refraction->humidity},
                  wcs.refraction->wavelength_um),
      at_horizon_rad_(refraction_.at_apparent_rad(0.0)),
      slope_at_horizon_((refraction_.at_apparent_rad(slope_over_rad) - at_horizon_rad_) /
                        slope_over_rad) {}

double RefractionShift::elevation_rad(PixelPosition pixel) const {
  const PixelPosition d = (pixel - principal_point_) * (1.0 / focal_length_px_);
  const auto v = lens_.direction_of(d.x_px, d.y_px);
  if (!v) return -0.5 * pi;
  return std::asin(
      std::clamp(dot(Vec<CameraFrame>{(*v)[0], (*v)[1], (*v)[2]}, zenith_), -1.0, 1.0));
}

PixelPosition RefractionShift::shift(PixelPosition pixel, bool smooth) const {
  const PixelPosition d = (pixel - principal_point_) * (1.0 / focal_length_px_);
  const auto v = lens_.direction_of(d.x_px, d.y_px);
  if (!v) return {};
  const Vec<CameraFrame> seen{(*v)[0], (*v)[1], (*v)[2]};
  const double sine = dot(seen, zenith_);
  const Vec<CameraFrame> level = seen - zenith_ * sine;
  const double cosine = norm(level);
  if (cosine < 1e-12) return offset_px_ * -1.0;
  const double elevation_rad = std::atan2(sine, cosine);
  const double r =
      smooth && elevation_rad < 0.0
          ? at_horizon_rad_ + slope_at_horizon_ * std::max(elevation_rad, lowest_smooth_rad)
          : refraction_.at_apparent_rad(elevation_rad);
  const double sin_r = r * (1 - r * r * (1.0 / 6 - r * r / 120)),  // r is below 0.02
      cos_r = 1 - r * r * (0.5 - r * r / 24);
  const Vec<CameraFrame> above_air = level * ((cosine * cos_r + sine * sin_r) / cosine) +
                                     zenith_ * (sine * cos_r - cosine * sin_r);
  const auto image = lens_.image_of(above_air.x, above_air.y, above_air.z);
  if (!image) return {};
  return PixelPosition{focal_length_px_ * ((*image)[0] - d.x_px),
                       focal_length_px_ * ((*image)[1] - d.y_px)} -
         offset_px_;
}

int shift_table_nodes(int pixels, double cell_px) {
  return 1 + static_cast<int>(std::ceil((pixels - ShiftTable::first_px) / cell_px));
}

ShiftTable shift_table(const Wcs& wcs, int columns, int rows) {
  const RefractionShift shift(wcs);
  ShiftTable table{.columns = shift_table_nodes(columns, wcs.refraction->cell_px),
                   .rows = shift_table_nodes(rows, wcs.refraction->cell_px),
                   .cell_px = wcs.refraction->cell_px};
  const std::size_t nodes = std::size_t(table.columns) * std::size_t(table.rows);
  table.x_px.reserve(nodes);
  table.y_px.reserve(nodes);
  for (int j = 0; j < table.rows; ++j)
    for (int i = 0; i < table.columns; ++i) {
      const PixelPosition by = shift.smooth_at(
          {ShiftTable::first_px + i * table.cell_px, ShiftTable::first_px + j * table.cell_px});
      table.x_px.push_back(float(by.x_px));
      table.y_px.push_back(float(by.y_px));
    }
  return table;
}

}  // namespace dmise
