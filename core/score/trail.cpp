#include "core/score/trail.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace dmise {
namespace {

double dot(PixelPosition a, PixelPosition b) { return a.x_px * b.x_px + a.y_px * b.y_px; }
double cross(PixelPosition a, PixelPosition b) { return a.x_px * b.y_px - a.y_px * b.x_px; }
double norm(PixelPosition a) { return std::hypot(a.x_px, a.y_px); }

}  // namespace

bool is_inside(PixelPosition place, int columns, int rows) {
  return place.x_px >= -0.5 && place.y_px >= -0.5 && place.x_px <= columns - 0.5 &&
         place.y_px <= rows - 0.5;
}

TrueTrail::TrueTrail(PixelPosition start, PixelPosition middle, PixelPosition end)
    : start_(start),
      slope_(middle * 4.0 - start * 3.0 - end),
      bend_(start * 2.0 + end * 2.0 - middle * 4.0) {
  for (std::size_t k = 0; k <= pieces; ++k) places_[k] = at(double(k) / pieces);
  for (std::size_t k = 1; k <= pieces; ++k)
    arc_px_[k] = arc_px_[k - 1] + norm(places_[k] - places_[k - 1]);
  const PixelPosition corner = start + slope_ * 0.5;  // where the tangents of the ends meet
  std::tie(least_.x_px, most_.x_px) = std::minmax({start.x_px, corner.x_px, end.x_px});
  std::tie(least_.y_px, most_.y_px) = std::minmax({start.y_px, corner.y_px, end.y_px});
}

bool TrueTrail::may_be_near(PixelPosition place, double distance_px) const {
  return place.x_px >= least_.x_px - distance_px && place.x_px <= most_.x_px + distance_px &&
         place.y_px >= least_.y_px - distance_px && place.y_px <= most_.y_px + distance_px;
}

PixelPosition TrueTrail::velocity(double u) const {
  return slope_ + bend_ * (2.0 * std::clamp(u, 0.0, 1.0));
}

PixelPosition TrueTrail::at(double u) const {
  const double v = std::clamp(u, 0.0, 1.0);
  return start_ + slope_ * v + bend_ * (v * v) + velocity(v) * (u - v);
}

PixelPosition TrueTrail::direction(double u) const {
  const PixelPosition v = velocity(u);
  const double speed = norm(v);
  return speed > 0.0 ? v * (1.0 / speed) : PixelPosition{1.0, 0.0};
}

double TrueTrail::arc_px(double u) const {
  if (u <= 0.0) return u * norm(velocity(0.0));
  if (u >= 1.0) return length_px() + (u - 1.0) * norm(velocity(1.0));
  const double k = std::floor(u * pieces);
  const auto i = std::size_t(std::min(k, pieces - 1.0));
  return arc_px_[i] + (u * pieces - double(i)) * (arc_px_[i + 1] - arc_px_[i]);
}

TrueTrail::Nearest TrueTrail::nearest(PixelPosition place) const {
  double best_u = 0.5, best_square = dot(place - places_[pieces / 2], place - places_[pieces / 2]);
  for (std::size_t k = 0; k < pieces; ++k) {
    const PixelPosition piece = places_[k + 1] - places_[k], off = place - places_[k];
    const double square = dot(piece, piece);
    if (square <= 0.0) continue;
    const double t = std::clamp(dot(off, piece) / square, 0.0, 1.0);
    const double distance = dot(off - piece * t, off - piece * t);
    if (distance < best_square) best_square = distance, best_u = (double(k) + t) / pieces;
  }
  // Newton's method for the foot of the perpendicular; on a tangent the first step is exact.
  double u = best_u;
  for (int step = 0; step < 4; ++step) {
    const PixelPosition v = velocity(u), off = at(u) - place;
    const double bend = u > 0.0 && u < 1.0 ? 2.0 * dot(off, bend_) : 0.0;
    const double slope = dot(v, v) + bend;
    if (slope <= 0.0 || !(dot(v, v) > 0.0)) break;
    u -= dot(off, v) / slope;
  }
  if (best_u > 0.0 && best_u < 1.0 && std::abs(u - best_u) > 2.0 / pieces) u = best_u;
  Nearest found{.u = u, .along_px = arc_px(u), .across_px = cross(direction(u), place - at(u))};
  found.distance_px = norm(place - at(std::clamp(u, 0.0, 1.0)));
  if (length_px() <= 0.0)
    found = {.across_px = found.distance_px, .distance_px = found.distance_px};
  return found;
}

double TrueTrail::length_inside_px(int columns, int rows) const {
  if (is_inside(least_, columns, rows) && is_inside(most_, columns, rows)) return length_px();
  constexpr int steps = 1024;
  double sum = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double u = (k + 0.5) / steps;
    if (is_inside(at(u), columns, rows)) sum += norm(velocity(u)) / steps;
  }
  return sum;
}

std::array<PixelPosition, 3> places_of(const Truth& truth) {
  PixelPosition start{truth.start_x_px, truth.start_y_px},
      middle{truth.middle_x_px, truth.middle_y_px}, end{truth.end_x_px, truth.end_y_px};
  const PixelPosition none;  // an instant at which the camera does not image the object
  if (!truth.whole && truth.rendered_signal_e > 0.0) {
    if (middle == none) middle = {truth.rendered_x_px, truth.rendered_y_px};
    if (start == none) start = end == none ? middle : middle * 2.0 - end;
    if (end == none) end = middle * 2.0 - start;
  }
  return {start, middle, end};
}

}  // namespace dmise
