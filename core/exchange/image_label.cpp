#include "core/exchange/image_label.h"

#include <algorithm>
#include <cmath>

#include "core/score/trail.h"

namespace dmise {
namespace {

PixelPosition unit(PixelPosition v) {
  const double length = std::hypot(v.x_px, v.y_px);
  return length > 0.0 ? v * (1.0 / length) : PixelPosition{1.0, 0.0};
}

/// Cuts a polygon along a line: keeps where sign * (coordinate - edge) >= 0 (Sutherland and Hodgman
/// 1974).
std::vector<PixelPosition> cut(const std::vector<PixelPosition>& polygon,
                               double PixelPosition::*coordinate, double edge, double sign) {
  const auto inside = [&](PixelPosition p) { return sign * (p.*coordinate - edge); };
  std::vector<PixelPosition> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PixelPosition a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double da = inside(a), db = inside(b);
    if (da >= 0.0) out.push_back(a);
    if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) {
      out.push_back(a + (b - a) * (da / (da - db)));
      out.back().*coordinate = edge;
    }
  }
  return out;
}

std::optional<ImageLabel> label(PixelPosition start, PixelPosition middle, PixelPosition end,
                                const RunFrame& frame, const RunSensor& camera) {
  ImageLabel l{start, middle, end, label_margin_fwhm * frame.psf_fwhm_px, {}};
  const auto outline = outline_of(l, camera.columns, camera.rows);
  if (area_px2(outline) <= 0.0) return std::nullopt;
  const auto [left, right] = std::minmax({start.x_px, middle.x_px, end.x_px});
  const auto [top, bottom] = std::minmax({start.y_px, middle.y_px, end.y_px});
  l.box = {left - l.margin_px, top - l.margin_px, right + l.margin_px, bottom + l.margin_px};
  const auto is_in_image = [&](PixelPosition p) {
    return is_inside(p, camera.columns, camera.rows);
  };
  if (is_in_image({l.box.left_px, l.box.top_px}) && is_in_image({l.box.right_px, l.box.bottom_px}))
    return l;
  // The part in the image: a trail that leaves it on a diagonal has a smaller box there.
  const auto [west, east] = std::ranges::minmax(outline, {}, &PixelPosition::x_px);
  const auto [north, south] = std::ranges::minmax(outline, {}, &PixelPosition::y_px);
  l.box = {std::max(l.box.left_px, west.x_px), std::max(l.box.top_px, north.y_px),
           std::min(l.box.right_px, east.x_px), std::min(l.box.bottom_px, south.y_px)};
  return l;
}

}  // namespace

std::optional<ImageLabel> label_of(const Truth& truth, const RunProducts& run) {
  if (!truth.in_frame) return std::nullopt;
  const auto [start, middle, end] = places_of(truth);
  return label(start, middle, end, run.frame(truth.sensor, truth.frame), run.sensor(truth.sensor));
}

std::optional<ImageLabel> label_of(const Detection& d, const RunProducts& run) {
  const PixelPosition middle{d.x_px, d.y_px};
  const bool streak = d.kind == DetectionKind::streak;
  return label(streak ? PixelPosition{d.end1_x_px, d.end1_y_px} : middle, middle,
               streak ? PixelPosition{d.end2_x_px, d.end2_y_px} : middle,
               run.frame(d.sensor, d.frame), run.sensor(d.sensor));
}

std::vector<PixelPosition> outline_of(const ImageLabel& l, int columns, int rows) {
  const PixelPosition along1 = unit(l.middle - l.start), along2 = unit(l.end - l.middle);
  const PixelPosition along = unit(along1 + along2);
  const auto across = [](PixelPosition v) { return PixelPosition{-v.y_px, v.x_px}; };
  const double w = l.margin_px;
  std::vector<PixelPosition> outline;
  for (const double side : {w, -w}) {
    const std::size_t begin = outline.size();
    outline.push_back(l.start - along1 * w + across(along1) * side);
    outline.push_back(l.middle + across(along) * side);
    outline.push_back(l.end + along2 * w + across(along2) * side);
    if (side < 0.0) std::reverse(outline.begin() + std::ptrdiff_t(begin), outline.end());
  }
  outline = cut(outline, &PixelPosition::x_px, -0.5, 1.0);
  outline = cut(outline, &PixelPosition::y_px, -0.5, 1.0);
  outline = cut(outline, &PixelPosition::x_px, columns - 0.5, -1.0);
  outline = cut(outline, &PixelPosition::y_px, rows - 0.5, -1.0);
  return outline;
}

double area_px2(const std::vector<PixelPosition>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PixelPosition a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    twice += a.x_px * b.y_px - b.x_px * a.y_px;
  }
  return std::abs(twice) / 2.0;
}

}  // namespace dmise
