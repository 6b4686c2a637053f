#include "core/detection/wcs.h"

#include <cmath>

#include "core/base/units.h"

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

}  // namespace

Vec<Gcrs> wcs_direction(const Wcs& wcs, PixelPosition pixel) {
  const double u = pixel.x_px - wcs.crpix_x, v = pixel.y_px - wcs.crpix_y;
  const double uu = u + evaluate(wcs.a, wcs.order, u, v).value;
  const double vv = v + evaluate(wcs.b, wcs.order, u, v).value;
  const double xi = (wcs.cd_deg[0] * uu + wcs.cd_deg[1] * vv) * deg;
  const double eta = (wcs.cd_deg[2] * uu + wcs.cd_deg[3] * vv) * deg;
  const TangentBasis t = tangent_basis(wcs);
  return unit(t.reference + t.east * xi + t.north * eta);
}

std::optional<PixelPosition> wcs_pixel(const Wcs& wcs, const Vec<Gcrs>& direction) {
  const TangentBasis t = tangent_basis(wcs);
  const double along = dot(direction, t.reference);
  if (!(along > 1e-9 * norm(direction))) return std::nullopt;
  const double xi = dot(direction, t.east) / along / deg;
  const double eta = dot(direction, t.north) / along / deg;
  const double det = wcs.cd_deg[0] * wcs.cd_deg[3] - wcs.cd_deg[1] * wcs.cd_deg[2];
  const double uu = (wcs.cd_deg[3] * xi - wcs.cd_deg[1] * eta) / det;
  const double vv = (wcs.cd_deg[0] * eta - wcs.cd_deg[2] * xi) / det;

  double u = uu + evaluate(wcs.ap, wcs.order, uu, vv).value;
  double v = vv + evaluate(wcs.bp, wcs.order, uu, vv).value;
  const double tolerance = 1e-9 + 1e-14 * (std::abs(u) + std::abs(v));
  for (int i = 0; i < 20; ++i) {
    const PolynomialValue f = evaluate(wcs.a, wcs.order, u, v);
    const PolynomialValue g = evaluate(wcs.b, wcs.order, u, v);
    const double ru = uu - u - f.value, rv = vv - v - g.value;
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

double wcs_scale_rad_per_px(const Wcs& wcs) {
  return std::sqrt(std::abs(wcs.cd_deg[0] * wcs.cd_deg[3] - wcs.cd_deg[1] * wcs.cd_deg[2])) * deg;
}

}  // namespace dmise
