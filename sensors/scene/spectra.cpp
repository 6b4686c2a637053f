#include "sensors/scene/spectra.h"

#include <cmath>

#include "core/optics/projection.h"
#include "core/sky/air/airmass.h"
#include "sensors/scene/throughput.h"

namespace dmise {
namespace {

/// A direction turned towards the zenith.
Vec<Gcrs> raised(const Vec<Gcrs>& direction, const Vec<Gcrs>& up, double angle_rad) {
  const Vec<Gcrs> across = up - direction * dot(direction, up);
  const double length = norm(across);
  if (!(length > 1e-12)) return direction;
  return direction * std::cos(angle_rad) + across * (std::sin(angle_rad) / length);
}

PixelPosition between(PixelPosition a, PixelPosition b, double t) {
  return {std::lerp(a.x_px, b.x_px, t), std::lerp(a.y_px, b.y_px, t)};
}

}  // namespace

std::optional<Spectra> Spectra::over(const View& view) {
  const EffectSet& effects = view.sensor().effects;
  if (!acts<Dispersion>(effects, view.scene())) return std::nullopt;
  return Spectra(view,
                 acts<AirExtinction>(effects, view.scene()) ? extinction_over(view) : Curve{});
}

Spectra::Spectra(const View& view, const Curve& extinction)
    : optics_(view.sensor().camera.optics),
      dispersion_(view.sensor().camera.band, extinction, view.refraction(),
                  acts<AtmosphericRefraction>(view.sensor().effects, view.scene())),
      up_(view.up(view.times().middle)),
      level_(view.sensor().effects.level(Dispersion::facts)) {}

SpectrumEnds Spectra::ends(const Vec<Gcrs>& apparent, double distance_m, const Vec<Gcrs>& up,
                           const Rotation<CameraFrame, Gcrs>& camera, PixelPosition pixel) const {
  const auto [blue_rad, red_rad] = dispersion_.ends(elevation_over(up, apparent), distance_m);
  const auto seen_at = [&](double angle_rad) {
    return project(optics_, camera * raised(apparent, up, angle_rad)).value_or(pixel);
  };
  return {seen_at(blue_rad), seen_at(red_rad)};
}

void Spectra::add(const Arc& arc, const Arc& blue, const Arc& red, const Vec<Gcrs>& apparent,
                  double bv, std::vector<Arc>& spread) const {
  const PixelPosition along = red.middle - blue.middle;
  std::vector<SpectrumCell> cells;
  dispersion_.band().add_cells(airmass(elevation_over(up_, apparent)), bv,
                               Dispersion::cells(level_, std::hypot(along.x_px, along.y_px)),
                               cells);
  for (const auto& [at, share] : cells)
    spread.push_back({between(blue.start, red.start, at), between(blue.middle, red.middle, at),
                      between(blue.end, red.end, at), arc.signal_e * share, arc.tilt});
}

}  // namespace dmise
