#include "core/astrometry/plate_model.h"

#include <cmath>

namespace dmise {
namespace {

const Vec<CameraFrame> boresight{0, 0, 1};

Vec<CameraFrame> rotated(const Vec<CameraFrame>& v, const Vec<CameraFrame>& by_rad) {
  const double angle = norm(by_rad);
  if (!(angle > 0)) return v;
  const Vec<CameraFrame> k = by_rad / angle;  // Rodrigues
  return v * std::cos(angle) + cross(k, v) * std::sin(angle) +
         k * (dot(k, v) * (1 - std::cos(angle)));
}

}  // namespace

int distortion_size(int order) { return order < 1 ? 0 : 2 + (order + 1) * (order + 2) - 6; }

void distortion_terms(int order, double u, double v, std::vector<PixelPosition>& moves) {
  moves.clear();
  if (order < 1) return;
  moves.push_back({u, -v});
  moves.push_back({v, u});
  for (int total = 2; total <= order; ++total)
    for (int q = 0; q <= total; ++q) {
      const double term = std::pow(u, total - q) * std::pow(v, q);
      moves.push_back({term, 0});
      moves.push_back({0, term});
    }
}

bool PlateModel::mirrored() const {
  const auto& m = camera_from_gcrs.m;
  const Vec<Gcrs> x{m[0][0], m[0][1], m[0][2]}, y{m[1][0], m[1][1], m[1][2]};
  return dot(cross(x, y), axis()) < 0;
}

Vec<Gcrs> PlateModel::axis() const { return camera_from_gcrs.inverse() * boresight; }

PixelPosition PlateModel::undistorted(PixelPosition pixel) const {
  const PixelPosition at = pixel - centre;
  PixelPosition out = at;
  if (order < 1) return out;
  std::vector<PixelPosition> moves;
  distortion_terms(order, at.x_px / unit_px, at.y_px / unit_px, moves);
  for (std::size_t i = 0; i < moves.size(); ++i) out = out + moves[i] * distortion[i];
  return out;
}

std::optional<PixelPosition> PlateModel::focal_place(const Vec<CameraFrame>& direction) const {
  const auto image = projection.image_of(direction.x, direction.y, direction.z);
  if (!image) return std::nullopt;
  return PixelPosition{(*image)[0] * focal_length_px, (*image)[1] * focal_length_px};
}

std::optional<PixelPosition> PlateModel::pixel(const Vec<Gcrs>& direction) const {
  const auto target = focal_place(direction);
  if (!target) return std::nullopt;
  PixelPosition at = *target + centre;
  if (order < 1) return at;
  for (int i = 0; i < 60; ++i) {  // a distortion changes slowly: each step leaves a fraction
    const PixelPosition missed = *target - undistorted(at);
    at = at + missed;
    const double size = std::hypot(missed.x_px, missed.y_px);
    if (size < 1e-9 * unit_px + 1e-9) return at;
    if (!(size < 10 * unit_px)) break;
  }
  return std::nullopt;
}

std::optional<Vec<Gcrs>> PlateModel::direction(PixelPosition pixel) const {
  const PixelPosition at = undistorted(pixel);
  const auto c = projection.direction_of(at.x_px / focal_length_px, at.y_px / focal_length_px);
  if (!c) return std::nullopt;
  return camera_from_gcrs.inverse() * Vec<CameraFrame>{(*c)[0], (*c)[1], (*c)[2]};
}

Rotation<CameraFrame, Gcrs> turned(const Rotation<CameraFrame, Gcrs>& rotation,
                                   const Vec<CameraFrame>& by_rad) {
  Rotation<CameraFrame, Gcrs> out;
  for (std::size_t j = 0; j < 3; ++j) {
    const Vec<CameraFrame> column =
        rotated({rotation.m[0][j], rotation.m[1][j], rotation.m[2][j]}, by_rad);
    out.m[0][j] = column.x;
    out.m[1][j] = column.y;
    out.m[2][j] = column.z;
  }
  return out;
}

Rotation<CameraFrame, Gcrs> triad(const Vec<CameraFrame>& u, const Vec<CameraFrame>& v,
                                  const Vec<Gcrs>& first, const Vec<Gcrs>& second) {
  const Vec<CameraFrame> u3 = unit(cross(u, v)), u2 = cross(u3, u);
  const Vec<Gcrs> s3 = unit(cross(first, second)), s2 = cross(s3, first);
  const auto row = [&](double a, double b, double c) {
    const Vec<Gcrs> r = first * a + s2 * b + s3 * c;
    return std::array{r.x, r.y, r.z};
  };
  Rotation<CameraFrame, Gcrs> out;
  out.m = {row(u.x, u2.x, u3.x), row(u.y, u2.y, u3.y), row(u.z, u2.z, u3.z)};
  return out;
}

Rotation<CameraFrame, Gcrs> flipped(Rotation<CameraFrame, Gcrs> rotation) {
  for (double& value : rotation.m[1]) value = -value;
  return rotation;
}

}  // namespace dmise
