#include "core/image/frame_header.h"

#include <algorithm>
#include <cmath>

namespace dmise {

// Shepperd's method: the largest of the four components is found first, so nothing cancels.
Quaternion quaternion_of(const Rotation<CameraFrame, Gcrs>& rotation) {
  const auto& m = rotation.m;
  const double trace = m[0][0] + m[1][1] + m[2][2];
  const std::array<double, 4> squares = {1 + trace, 1 + 2 * m[0][0] - trace,
                                         1 + 2 * m[1][1] - trace, 1 + 2 * m[2][2] - trace};
  const auto largest = std::max_element(squares.begin(), squares.end()) - squares.begin();
  const double s = 0.5 / std::sqrt(squares[std::size_t(largest)]);
  const double big = 0.5 * std::sqrt(squares[std::size_t(largest)]);
  switch (largest) {
    case 0:
      return {big, (m[2][1] - m[1][2]) * s, (m[0][2] - m[2][0]) * s, (m[1][0] - m[0][1]) * s};
    case 1:
      return {(m[2][1] - m[1][2]) * s, big, (m[1][0] + m[0][1]) * s, (m[0][2] + m[2][0]) * s};
    case 2:
      return {(m[0][2] - m[2][0]) * s, (m[1][0] + m[0][1]) * s, big, (m[2][1] + m[1][2]) * s};
    default:
      return {(m[1][0] - m[0][1]) * s, (m[0][2] + m[2][0]) * s, (m[2][1] + m[1][2]) * s, big};
  }
}

Rotation<CameraFrame, Gcrs> rotation_of(const Quaternion& q) {
  const double n = 1.0 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  const double w = q.w * n, x = q.x * n, y = q.y * n, z = q.z * n;
  Rotation<CameraFrame, Gcrs> r;
  r.m = {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
  return r;
}

const char* projection_name(Projection projection) {
  switch (projection) {
    case Projection::gnomonic:
      return "gnomonic";
    case Projection::equidistant:
      return "equidistant";
    case Projection::equisolid:
      return "equisolid";
    case Projection::stereographic:
      return "stereographic";
  }
  return "unknown";
}

std::optional<Projection> projection_named(const std::string& name) {
  for (const auto projection : {Projection::gnomonic, Projection::equidistant,
                                Projection::equisolid, Projection::stereographic})
    if (name == projection_name(projection)) return projection;
  return std::nullopt;
}

}  // namespace dmise
