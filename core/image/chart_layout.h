#pragma once
#include <string>
#include <vector>

#include "core/image/chart.h"

namespace dmise {

/// A place on the page [px], y down.
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
  double size_px = 14.0;  // height of a capital and what hangs below it
  Colour colour;
  Anchor anchor = Anchor::start;
  bool upwards = false;  // turned by 90 deg, read from below
};

/// What a chart is drawn with. To add an output: implement it, and call `draw_chart`.
class ChartPen {
 public:
  virtual ~ChartPen() = default;
  virtual void rectangle(PagePoint corner, double width_px, double height_px, Colour fill) = 0;
  /// Lines of one kind inside a window that cuts them off.
  virtual void lines(const std::vector<std::vector<PagePoint>>& lines, const Stroke& stroke,
                     PagePoint window, double width_px, double height_px) = 0;
  /// `at`: on the base line of the text.
  virtual void text(PagePoint at, const std::string& text, const TextStyle& style) = 0;
  /// Columns that a text takes.
  virtual double text_width_px(const std::string& text, double size_px) const = 0;
};

void draw_chart(const Chart& chart, ChartPen& pen);

}  // namespace dmise
