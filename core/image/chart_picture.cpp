#include <algorithm>
#include <cmath>

#include "core/image/chart_layout.h"
#include "core/image/font.h"

namespace dmise {
namespace {

/// Columns of the 5 x 7 font that a glyph uses.
struct Extent {
  int first = 0, last = 2;  // a blank's
  double advance() const { return last - first + 2.6; }
};

Extent extent_of(char letter) {
  if (letter >= '0' && letter <= '9') return {0, glyph_columns - 1};  // digits have equal width
  unsigned used = 0;
  for (const auto row : glyph(letter)) used |= row;
  if (used == 0) return {};
  Extent e{glyph_columns, 0};
  for (int x = 0; x < glyph_columns; ++x)
    if (used >> (glyph_columns - 1 - x) & 1) e = {std::min(e.first, x), x};
  return e;
}

/// Letters with a descender that the font draws on the base line.
bool has_descender(char letter) {
  return letter == 'g' || letter == 'p' || letter == 'q' || letter == 'y' || letter == ',';
}

/// Antialiased drawing: the coverage of a pixel is its centre's distance from the line.
class PicturePen : public ChartPen {
 public:
  PicturePen(int columns, int rows)
      : picture_{columns, rows, 3, {}}, coverage_(std::size_t(columns) * std::size_t(rows), 0.0f) {
    picture_.pixels.assign(3 * coverage_.size(), 255);
  }
  Picture finish() { return std::move(picture_); }

  void rectangle(PagePoint corner, double width_px, double height_px, Colour fill) override {
    const int x1 = std::max(0, int(std::lround(corner.x_px)));
    const int y1 = std::max(0, int(std::lround(corner.y_px)));
    const int x2 = std::min(picture_.columns, int(std::lround(corner.x_px + width_px)));
    const int y2 = std::min(picture_.rows, int(std::lround(corner.y_px + height_px)));
    for (int y = y1; y < y2; ++y)
      for (int x = x1; x < x2; ++x) blend(x, y, fill, 1.0f);
  }

  void lines(const std::vector<std::vector<PagePoint>>& lines, const Stroke& stroke,
             PagePoint window, double width_px, double height_px) override {
    const Window inside{std::max(0, int(window.x_px)), std::max(0, int(window.y_px)),
                        std::min(picture_.columns, int(window.x_px + width_px)),
                        std::min(picture_.rows, int(window.y_px + height_px))};
    for (const auto& line : lines) polyline(line, stroke, inside);
  }

  /// Letters are strokes between neighbouring dots of the 5 x 7 font.
  void text(PagePoint at, const std::string& text, const TextStyle& style) override {
    const double dot = style.size_px / cells_high;
    const double before = style.anchor == Anchor::start ? 0.0
                          : style.anchor == Anchor::end ? text_width_px(text, style.size_px)
                                                        : 0.5 * text_width_px(text, style.size_px);
    const Stroke stroke{style.colour, std::max(1.0, 0.78 * dot), 1.0};
    const Window all{0, 0, picture_.columns, picture_.rows};
    double pen = -before;
    for (const char letter : text) {
      const auto rows = glyph(letter);
      const Extent extent = extent_of(letter);
      const double drop = has_descender(letter) ? 1.5 * dot : 0.0;
      const auto set = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < glyph_columns && y < glyph_rows &&
               (rows[std::size_t(y)] >> (glyph_columns - 1 - x) & 1);
      };
      const auto place = [&](int x, int y) -> PagePoint {
        const double along = pen + (x - extent.first + 0.5) * dot;
        const double up = (glyph_rows - 1 - y) * dot - drop;
        return style.upwards ? PagePoint{at.x_px - up, at.y_px - along}
                             : PagePoint{at.x_px + along, at.y_px - up};
      };
      begin();
      for (int y = 0; y < glyph_rows; ++y)
        for (int x = 0; x < glyph_columns; ++x) {
          if (!set(x, y)) continue;
          const PagePoint here = place(x, y);
          const bool right = set(x + 1, y), down = set(x, y + 1), left = set(x - 1, y);
          segment(here, here, stroke.width_px, all);
          if (right) segment(here, place(x + 1, y), stroke.width_px, all);
          if (down) segment(here, place(x, y + 1), stroke.width_px, all);
          if (!right && !down && set(x + 1, y + 1))
            segment(here, place(x + 1, y + 1), stroke.width_px, all);
          if (!left && !down && set(x - 1, y + 1))
            segment(here, place(x - 1, y + 1), stroke.width_px, all);
        }
      end(stroke);
      pen += extent.advance() * dot;
    }
  }

  double text_width_px(const std::string& text, double size_px) const override {
    double dots = 0.0;
    for (const char letter : text) dots += extent_of(letter).advance();
    return dots * size_px / cells_high;
  }

 private:
  static constexpr double cells_high = 9.5;  // dots in the size of a text

  struct Window {
    int x1 = 0, y1 = 0, x2 = 0, y2 = 0;  // the second pair is exclusive
  };

  // Between begin() and end() overlapping segments do not add up.
  void begin() { touched_ = {picture_.columns, picture_.rows, 0, 0}; }
  void end(const Stroke& stroke) {
    for (int y = touched_.y1; y < touched_.y2; ++y)
      for (int x = touched_.x1; x < touched_.x2; ++x) {
        float& c = coverage(x, y);
        if (c > 0.0f) blend(x, y, stroke.colour, c * float(stroke.opacity));
        c = 0.0f;
      }
  }
  void polyline(const std::vector<PagePoint>& line, const Stroke& stroke, const Window& window) {
    begin();
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
      segment(line[k], line[k + 1], stroke.width_px, window);
    end(stroke);
  }
  void segment(PagePoint a, PagePoint b, double width_px, const Window& window) {
    const double reach = 0.5 * width_px + 0.5;
    const auto clamped = [](double v, int low, int high) {
      return int(std::clamp(v, double(low), double(high)));
    };
    const int x1 = clamped(std::floor(std::min(a.x_px, b.x_px) - reach), window.x1, window.x2);
    const int x2 = clamped(std::ceil(std::max(a.x_px, b.x_px) + reach) + 1, window.x1, window.x2);
    const int y1 = clamped(std::floor(std::min(a.y_px, b.y_px) - reach), window.y1, window.y2);
    const int y2 = clamped(std::ceil(std::max(a.y_px, b.y_px) + reach) + 1, window.y1, window.y2);
    if (x1 >= x2 || y1 >= y2) return;
    const double dx = b.x_px - a.x_px, dy = b.y_px - a.y_px, square = dx * dx + dy * dy;
    for (int y = y1; y < y2; ++y)
      for (int x = x1; x < x2; ++x) {
        const double u = x - a.x_px, v = y - a.y_px;
        const double t = square > 0 ? std::clamp((u * dx + v * dy) / square, 0.0, 1.0) : 0.0;
        const double away = std::hypot(u - t * dx, v - t * dy);
        const float cover = float(std::clamp(reach - away, 0.0, 1.0));
        coverage(x, y) = std::max(coverage(x, y), cover);
      }
    touched_ = {std::min(touched_.x1, x1), std::min(touched_.y1, y1), std::max(touched_.x2, x2),
                std::max(touched_.y2, y2)};
  }
  float& coverage(int x, int y) {
    return coverage_[std::size_t(y) * std::size_t(picture_.columns) + std::size_t(x)];
  }
  void blend(int x, int y, Colour colour, float share) {
    auto* at = picture_.pixels.data() +
               3 * (std::size_t(y) * std::size_t(picture_.columns) + std::size_t(x));
    const std::uint8_t channels[3] = {colour.red, colour.green, colour.blue};
    for (int c = 0; c < 3; ++c)
      at[c] = std::uint8_t(std::lround(at[c] + share * (float(channels[c]) - float(at[c]))));
  }

  Picture picture_;
  std::vector<float> coverage_;
  Window touched_;
};

}  // namespace

Picture drawn_picture(int width_px, int height_px, const std::function<void(ChartPen&)>& draw) {
  PicturePen pen(width_px, height_px);
  draw(pen);
  return pen.finish();
}

Picture chart_picture(const Chart& chart) {
  return drawn_picture(chart.width_px, chart.height_px,
                       [&](ChartPen& pen) { draw_chart(chart, pen); });
}

}  // namespace dmise
