#include "core/optics/wcs_fit.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/least_squares.h"
#include "core/base/units.h"
#include "core/detection/wcs.h"

namespace dmise {
namespace {

constexpr double reach_cos = 0.5;  // of 60 deg
constexpr int fit_points = 24, check_points = 37;

struct Sample {
  PixelPosition pixel;
  Vec<Gcrs> direction;
  double weight = 0.0;  // pixels per radian on the tangent plane
};

// Coordinates on the plane that touches the sphere at a Wcs' reference, east and north [rad].
struct TangentPlane {
  Vec<Gcrs> reference, east, north;

  explicit TangentPlane(const Vec<Gcrs>& direction) : reference(unit(direction)) {
    const auto [ra, dec] = to_spherical(reference);
    east = {-std::sin(ra), std::cos(ra), 0.0};
    north = cross(reference, east);
  }
  double xi(const Vec<Gcrs>& v) const { return dot(v, east) / dot(v, reference); }
  double eta(const Vec<Gcrs>& v) const { return dot(v, north) / dot(v, reference); }
};

// What a pixel and its edges see.
struct Seen {
  PixelPosition pixel;
  Vec<Gcrs> middle, right, left, down, up;
};

std::vector<Seen> look(int columns, int rows, const SkyOfPixel& sky, int points) {
  std::vector<Seen> all;
  const auto place = [&](int k, int size) {
    return 0.5 * (size - 1) - 0.5 * size * std::cos(pi * k / (points - 1));
  };
  for (int j = 0; j < points; ++j)
    for (int i = 0; i < points; ++i) {
      const PixelPosition pixel{place(i, columns), place(j, rows)};
      const auto middle = sky(pixel), right = sky(pixel + PixelPosition{0.5, 0.0}),
                 left = sky(pixel - PixelPosition{0.5, 0.0}),
                 down = sky(pixel + PixelPosition{0.0, 0.5}),
                 up = sky(pixel - PixelPosition{0.0, 0.5});
      if (middle && right && left && down && up)
        all.push_back({pixel, unit(*middle), *right, *left, *down, *up});
    }
  return all;
}

std::vector<Sample> samples_on(const TangentPlane& plane, const std::vector<Seen>& all) {
  std::vector<Sample> samples;
  for (const Seen& s : all) {
    if (dot(s.middle, plane.reference) < reach_cos) continue;
    const double area =
        (plane.xi(s.right) - plane.xi(s.left)) * (plane.eta(s.down) - plane.eta(s.up)) -
        (plane.xi(s.down) - plane.xi(s.up)) * (plane.eta(s.right) - plane.eta(s.left));
    const double weight = 1.0 / std::sqrt(std::abs(area));
    if (std::isfinite(weight)) samples.push_back({s.pixel, s.middle, weight});
  }
  return samples;
}

// Exponents of the terms u^p v^q with lowest <= p + q <= order.
std::vector<std::array<int, 2>> terms(int lowest, int order) {
  std::vector<std::array<int, 2>> list;
  for (int total = lowest; total <= order; ++total)
    for (int p = total; p >= 0; --p) list.push_back({p, total - p});
  return list;
}

// Fits two weighted quantities as polynomials in (u, v) / scale; returns terms x 2.
template <class Point, class Value>
std::vector<double> fit(const std::vector<Sample>& samples,
                        const std::vector<std::array<int, 2>>& list, double scale,
                        const Point& point, const Value& value) {
  std::vector<double> a, b;
  for (const Sample& s : samples) {
    const auto [u, v] = point(s);
    for (const auto& [p, q] : list)
      a.push_back(s.weight * std::pow(u / scale, p) * std::pow(v / scale, q));
    const auto [f, g] = value(s);
    b.push_back(s.weight * f);
    b.push_back(s.weight * g);
  }
  auto x = least_squares(std::move(a), list.size(), std::move(b), 2);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const double unscale = std::pow(scale, -(list[i][0] + list[i][1]));
    x[2 * i] *= unscale;
    x[2 * i + 1] *= unscale;
  }
  return x;
}

}  // namespace

Wcs fit_wcs(int columns, int rows, const SkyOfPixel& sky, int order) {
  if (order < 0 || order > 5) throw Error("fit_wcs: order must be 0..5");
  const PixelPosition centre{0.5 * (columns - 1), 0.5 * (rows - 1)};
  auto reference = sky(centre);
  if (!reference) throw Error("fit_wcs: the frame's centre sees no sky");

  Wcs w;
  w.crpix_x = centre.x_px;
  w.crpix_y = centre.y_px;
  w.order = order < 2 ? 0 : order;
  const double scale = 0.5 * std::max(columns, rows);
  const auto list = terms(0, std::max(1, order));
  const auto seen = look(columns, rows, sky, fit_points);
  std::vector<Sample> samples;
  std::vector<double> c;
  // The constant term moves the reference direction until it is nothing.
  for (int pass = 0; pass < 4; ++pass) {
    const TangentPlane plane(*reference);
    samples = samples_on(plane, seen);
    if (samples.size() < list.size()) throw Error("fit_wcs: too few pixels see sky");
    c = fit(
        samples, list, scale,
        [&](const Sample& s) {
          return std::array{s.pixel.x_px - w.crpix_x, s.pixel.y_px - w.crpix_y};
        },
        [&](const Sample& s) {
          return std::array{plane.xi(s.direction), plane.eta(s.direction)};
        });
    const auto [ra, dec] = to_spherical(plane.reference);
    w.ra_rad = ra;
    w.dec_rad = dec;
    if (pass < 3) reference = plane.reference + plane.east * c[0] + plane.north * c[1];
  }
  w.cd_deg = {c[2] / deg, c[4] / deg, c[3] / deg, c[5] / deg};
  const double det = c[2] * c[5] - c[4] * c[3];

  if (w.order) {
    const auto side = std::size_t(order + 1);
    for (auto* polynomial : {&w.a, &w.b, &w.ap, &w.bp}) polynomial->assign(side * side, 0.0);
    for (std::size_t i = 3; i < list.size(); ++i) {
      const std::size_t at = std::size_t(list[i][0]) * side + std::size_t(list[i][1]);
      w.a[at] = (c[5] * c[2 * i] - c[4] * c[2 * i + 1]) / det;
      w.b[at] = (c[2] * c[2 * i + 1] - c[3] * c[2 * i]) / det;
    }
    const TangentPlane plane(from_spherical<Gcrs>(w.ra_rad, w.dec_rad));
    const auto linear = [&](const Sample& s) {
      const double xi = plane.xi(s.direction), eta = plane.eta(s.direction);
      return std::array{(c[5] * xi - c[4] * eta) / det, (c[2] * eta - c[3] * xi) / det};
    };
    for (Sample& s : samples) s.weight = 1.0;
    const auto inverse = fit(samples, list, scale, linear, [&](const Sample& s) {
      const auto [u, v] = linear(s);
      return std::array{s.pixel.x_px - w.crpix_x - u, s.pixel.y_px - w.crpix_y - v};
    });
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::size_t at = std::size_t(list[i][0]) * side + std::size_t(list[i][1]);
      w.ap[at] = inverse[2 * i];
      w.bp[at] = inverse[2 * i + 1];
    }
  }

  const TangentPlane plane(from_spherical<Gcrs>(w.ra_rad, w.dec_rad));
  double sum = 0.0;
  const auto checks = samples_on(plane, look(columns, rows, sky, check_points));
  for (const Sample& s : checks) {
    const Vec<Gcrs> got = wcs_direction(w, s.pixel);
    const double error_px = s.weight * std::hypot(plane.xi(got) - plane.xi(s.direction),
                                                  plane.eta(got) - plane.eta(s.direction));
    sum += error_px * error_px;
    w.max_px = std::max(w.max_px, error_px);
  }
  w.rms_px = std::sqrt(sum / double(checks.size()));
  return w;
}

}  // namespace dmise
