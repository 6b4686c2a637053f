#include "core/image/charts/drawing.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/image/charts/font.h"

namespace dmise {
namespace {

void set(Picture& picture, long x, long y, Colour colour) {
  if (x < 0 || y < 0 || x >= picture.columns || y >= picture.rows) return;
  auto* at =
      picture.pixels.data() + 3 * (std::size_t(y) * std::size_t(picture.columns) + std::size_t(x));
  at[0] = colour.red;
  at[1] = colour.green;
  at[2] = colour.blue;
}

/// Clips a segment to the picture (Liang-Barsky), so that distant ends are cheap.
bool clip(const Picture& picture, double& x1, double& y1, double& x2, double& y2) {
  double from = 0.0, to = 1.0;
  const auto side = [&](double step, double room) {
    if (step == 0.0) return room >= 0.0;
    const double t = room / step;
    if (step < 0.0)
      from = std::max(from, t);
    else
      to = std::min(to, t);
    return from <= to;
  };
  const double dx = x2 - x1, dy = y2 - y1;
  if (!std::isfinite(dx) || !std::isfinite(dy)) return false;
  if (!side(-dx, x1 + 1) || !side(dx, picture.columns - x1) || !side(-dy, y1 + 1) ||
      !side(dy, picture.rows - y1))
    return false;
  x2 = x1 + to * dx;
  y2 = y1 + to * dy;
  x1 += from * dx;
  y1 += from * dy;
  return true;
}

void draw_arc(Picture& picture, double x, double y, double radius, double from_rad, double to_rad,
              Colour colour) {
  const double across = 2 * (picture.columns + picture.rows);
  if (!(radius < across) || !std::isfinite(x) || !std::isfinite(y)) return;
  if (x < -radius || y < -radius || x > picture.columns + radius || y > picture.rows + radius)
    return;
  const int steps = std::max(8, int(std::ceil(1.5 * radius * (to_rad - from_rad))));
  for (int i = 0; i <= steps; ++i) {
    const double angle = from_rad + (to_rad - from_rad) * i / steps;
    set(picture, std::lround(x + radius * std::cos(angle)),
        std::lround(y + radius * std::sin(angle)), colour);
  }
}

}  // namespace

Picture to_rgb(const Picture& picture, int strip_rows) {
  Picture out{picture.columns, picture.rows + strip_rows, 3, {}};
  out.pixels.resize(std::size_t(out.columns) * std::size_t(out.rows) * 3, 0);
  const std::size_t in_channels = std::size_t(picture.channels);
  const std::size_t count = std::size_t(picture.columns) * std::size_t(picture.rows);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      out.pixels[3 * i + c] = picture.pixels[in_channels * i + (in_channels == 3 ? c : 0)];
  return out;
}

void draw_line(Picture& picture, double x1, double y1, double x2, double y2, Colour colour) {
  if (!clip(picture, x1, y1, x2, y2)) return;
  const int steps = std::max(1, int(std::ceil(std::max(std::abs(x2 - x1), std::abs(y2 - y1)))));
  for (int i = 0; i <= steps; ++i) {
    const double t = double(i) / steps;
    set(picture, std::lround(x1 + t * (x2 - x1)), std::lround(y1 + t * (y2 - y1)), colour);
  }
}

void draw_circle(Picture& picture, double x, double y, double radius, Colour colour) {
  draw_arc(picture, x, y, radius, 0.0, 2 * pi, colour);
}

void draw_capsule(Picture& picture, double x1, double y1, double x2, double y2, double half_width,
                  Colour colour) {
  const double length = std::hypot(x2 - x1, y2 - y1);
  if (!(length > 0)) return draw_circle(picture, x1, y1, half_width, colour);
  const double nx = -(y2 - y1) / length * half_width, ny = (x2 - x1) / length * half_width;
  draw_line(picture, x1 + nx, y1 + ny, x2 + nx, y2 + ny, colour);
  draw_line(picture, x1 - nx, y1 - ny, x2 - nx, y2 - ny, colour);
  const double along = std::atan2(y2 - y1, x2 - x1);
  draw_arc(picture, x2, y2, half_width, along - pi / 2, along + pi / 2, colour);
  draw_arc(picture, x1, y1, half_width, along + pi / 2, along + 3 * pi / 2, colour);
}

void draw_text(Picture& picture, int x, int y, std::string_view text, Colour colour, int scale) {
  for (const char letter : text) {
    const auto rows = glyph(letter);
    for (int j = 0; j < glyph_rows * scale; ++j)
      for (int i = 0; i < glyph_columns * scale; ++i)
        if (rows[std::size_t(j / scale)] >> (glyph_columns - 1 - i / scale) & 1)
          set(picture, x + i, y + j, colour);
    x += (glyph_columns + 1) * scale;
  }
}

int text_width(std::string_view text, int scale) {
  return int(text.size()) * (glyph_columns + 1) * scale;
}

}  // namespace dmise
