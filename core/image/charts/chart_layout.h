#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/image/charts/chart.h"

namespace dmise {

/// A point on the page [px], y down.
struct PagePoint {
  double x_px = 0.0, y_px = 0.0;
};

struct Stroke {
  Colour colour;
  double width_px = 1.0;
  double opacity = 1.0;  // (0, 1]
};

enum class Anchor { start, middle, end };

struct TextStyle {
  double size_px = 14.0;  // height of a capital plus descender
  Colour colour;
  Anchor anchor = Anchor::start;
  bool upwards = false;  // rotated by 90 deg, read from below
};

/// Draws the elements of a chart in a format. To add a format: implement it and call `draw_chart`.
class ChartPen {
 public:
  virtual ~ChartPen() = default;
  virtual void rectangle(PagePoint corner, double width_px, double height_px, Colour fill) = 0;
  /// Draws lines of one kind, clipped to a window.
  virtual void lines(const std::vector<std::vector<PagePoint>>& lines, const Stroke& stroke,
                     PagePoint window, double width_px, double height_px) = 0;
  /// `at`: on the base line of the text.
  virtual void text(PagePoint at, const std::string& text, const TextStyle& style) = 0;
  /// Width of a text.
  virtual double text_width_px(const std::string& text, double size_px) const = 0;
};

void draw_chart(const Chart& chart, ChartPen& pen);

/// What `draw` draws, as SVG 1.1.
std::string drawn_svg(int width_px, int height_px, const std::function<void(ChartPen&)>& draw);

}  // namespace dmise
