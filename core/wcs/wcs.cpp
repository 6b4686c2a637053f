#include "core/wcs/wcs.h"

#include <cmath>

#include "core/base/units.h"
#include "core/wcs/wcs_refraction.h"

namespace dmise {
namespace {

// Value and derivatives of sum c_pq u^p v^q.
struct PolynomialValue {
  double value = 0.0, du = 0.0, dv = 0.0;
};

PolynomialValue evaluate(const std::vector<double>& c, int order, double u, double v) {
  PolynomialValue r;
  if (c.empty()) return r;
  for (int p = order; p >= 0; --p) {
    double row = 0.0, row_dv = 0.0;
    for (int q = order - p; q >= 0; --q) {
      row_dv = row_dv * v + row;
      row = row * v + c[std::size_t(p * (order + 1) + q)];
    }
    r.du = r.du * u + r.value;
    r.value = r.value * u + row;
    r.dv = r.dv * u + row_dv;
  }
  return r;
}

struct TangentBasis {
  Vec<Gcrs> reference, east, north;
};

TangentBasis tangent_basis(const Wcs& wcs) {
  const double ca = std::cos(wcs.ra_rad), sa = std::sin(wcs.ra_rad);
  const double cd = std::cos(wcs.dec_rad), sd = std::sin(wcs.dec_rad);
  return {{ca * cd, sa * cd, sd}, {-sa, ca, 0.0}, {-ca * sd, -sa * sd, cd}};
}

std::optional<RefractionShift> air_of(const Wcs& wcs) {
  return wcs.refraction ? std::optional<RefractionShift>(wcs) : std::nullopt;
}

/// Position on the projection plane [rad], east and north.
std::array<double, 2> plane_of_focal(const Wcs& wcs, PixelPosition place) {
  return {(wcs.cd_deg[0] * place.x_px + wcs.cd_deg[1] * place.y_px) * deg,
          (wcs.cd_deg[2] * place.x_px + wcs.cd_deg[3] * place.y_px) * deg};
}

}  // namespace

PixelPosition wcs_focal_place(const Wcs& wcs, PixelPosition pixel) {
  const double u = pixel.x_px - wcs.crpix_x, v = pixel.y_px - wcs.crpix_y;
  const PixelPosition place{u + evaluate(wcs.a, wcs.order, u, v).value,
                            v + evaluate(wcs.b, wcs.order, u, v).value};
  const auto air = air_of(wcs);
  return air ? place + air->at(pixel) : place;
}

std::optional<PixelPosition> wcs_focal_place(const Wcs& wcs, const Vec<Gcrs>& direction) {
  const TangentBasis t = tangent_basis(wcs);
  const Vec<Gcrs> v = unit(direction);
  const auto image = wcs.projection.image_of(dot(v, t.east), dot(v, t.north), dot(v, t.reference));
  if (!image) return std::nullopt;
  const double xi = (*image)[0] / deg, eta = (*image)[1] / deg;
  const double det = wcs.cd_deg[0] * wcs.cd_deg[3] - wcs.cd_deg[1] * wcs.cd_deg[2];
  return PixelPosition{(wcs.cd_deg[3] * xi - wcs.cd_deg[1] * eta) / det,
                       (wcs.cd_deg[0] * eta - wcs.cd_deg[2] * xi) / det};
}

Vec<Gcrs> wcs_direction(const Wcs& wcs, PixelPosition pixel) {
  const auto [xi, eta] = plane_of_focal(wcs, wcs_focal_place(wcs, pixel));
  auto local = wcs.projection.direction_of(xi, eta);
  if (!local) {  // at the rim
    const double shrink = wcs.projection.rim() * (1 - 1e-12) / std::hypot(xi, eta);
    local = wcs.projection.direction_of(xi * shrink, eta * shrink);
  }
  const TangentBasis t = tangent_basis(wcs);
  return unit(t.reference * (*local)[2] + t.east * (*local)[0] + t.north * (*local)[1]);
}

std::optional<PixelPosition> wcs_pixel(const Wcs& wcs, const Vec<Gcrs>& direction) {
  const auto target = wcs_focal_place(wcs, direction);
  if (!target) return std::nullopt;
  const auto air = air_of(wcs);
  const double uu = target->x_px, vv = target->y_px;
  double u = uu + evaluate(wcs.ap, wcs.order, uu, vv).value;
  double v = vv + evaluate(wcs.bp, wcs.order, uu, vv).value;
  const double tolerance = 1e-9 + 1e-14 * (std::abs(u) + std::abs(v));
  // The slope of the refraction, below 0.2, is ignored: each step leaves a fifth of the error.
  const int max_steps = air ? 40 : 20;
  for (int i = 0; i < max_steps; ++i) {
    const PolynomialValue f = evaluate(wcs.a, wcs.order, u, v);
    const PolynomialValue g = evaluate(wcs.b, wcs.order, u, v);
    const PixelPosition by = air ? air->at({u + wcs.crpix_x, v + wcs.crpix_y}) : PixelPosition{};
    const double ru = uu - u - f.value - by.x_px, rv = vv - v - g.value - by.y_px;
    if (!(std::abs(ru) + std::abs(rv) < 1e12)) return std::nullopt;
    if (std::abs(ru) + std::abs(rv) <= tolerance)
      return PixelPosition{u + wcs.crpix_x, v + wcs.crpix_y};
    const double j11 = 1.0 + f.du, j12 = f.dv, j21 = g.du, j22 = 1.0 + g.dv;
    const double jacobian = j11 * j22 - j12 * j21;
    u += (j22 * ru - j12 * rv) / jacobian;
    v += (j11 * rv - j21 * ru) / jacobian;
  }
  return std::nullopt;
}

bool wcs_sees_sky(const Wcs& wcs, PixelPosition pixel) {
  const auto [xi, eta] = plane_of_focal(wcs, wcs_focal_place(wcs, pixel));
  if (!wcs.projection.direction_of(xi, eta)) return false;
  const auto air = air_of(wcs);
  return !air || air->elevation_rad(pixel) > -wcs_scale_rad_per_px(wcs);
}

double wcs_scale_rad_per_px(const Wcs& wcs) {
  return std::sqrt(std::abs(wcs.cd_deg[0] * wcs.cd_deg[3] - wcs.cd_deg[1] * wcs.cd_deg[2])) * deg;
}

}  // namespace dmise
