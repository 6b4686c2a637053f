#include "core/image/charts/chart_layout.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/formatted.h"

namespace dmise {
namespace {

constexpr Colour ink = {32, 36, 42}, dim = {96, 102, 110}, paper = {255, 255, 255};
constexpr Colour grid_colour = {222, 225, 229}, band_colour = {238, 240, 244};
constexpr double simplified_px = 0.3;  // tolerance of line simplification

/// The points of a line that keep it within `simplified_px` (Douglas and Peucker 1973).
std::vector<PagePoint> simplified(const std::vector<PagePoint>& line) {
  if (line.size() < 3) return line;
  std::vector<bool> kept(line.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() - 1}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    const double dx = line[b].x_px - line[a].x_px, dy = line[b].y_px - line[a].y_px;
    const double length = std::hypot(dx, dy);
    double most = simplified_px;
    std::size_t at = a;
    for (std::size_t k = a + 1; k < b; ++k) {
      const double x = line[k].x_px - line[a].x_px, y = line[k].y_px - line[a].y_px;
      const double away = length > 0 ? std::abs(dx * y - dy * x) / length : std::hypot(x, y);
      if (away > most) most = away, at = k;
    }
    if (at == a) continue;
    kept[at] = true;
    open.push_back({a, at});
    open.push_back({at, b});
  }
  std::vector<PagePoint> out;
  for (std::size_t k = 0; k < line.size(); ++k)
    if (kept[k]) out.push_back(line[k]);
  return out;
}

/// Position of a value on an axis, 0 at its beginning and 1 at its end.
double share(const ChartAxis& axis, double value) {
  if (!axis.logarithmic) return (value - axis.least) / (axis.most - axis.least);
  return std::log(std::max(value, 1e-300) / axis.least) / std::log(axis.most / axis.least);
}

class Page {
 public:
  Page(const Chart& chart, ChartPen& pen) : chart_(chart), pen_(pen) {}

  void draw() {
    pen_.rectangle({0, 0}, chart_.width_px, chart_.height_px, paper);
    for (const ChartBand& band : chart_.bands) {
      const double from = std::clamp(share(chart_.x, band.from), 0.0, 1.0);
      const double to = std::clamp(share(chart_.x, band.to), 0.0, 1.0);
      pen_.rectangle({left + from * width_, top}, (to - from) * width_, height_, band_colour);
    }
    axes();
    for (const ChartSeries& series : chart_.series) lines(series);
    frame();
    pen_.text({left, 32}, chart_.title, {.size_px = 20, .colour = ink});
    pen_.text({left, 54}, chart_.subtitle, {.size_px = 14, .colour = dim});
    legend();
  }

 private:
  static constexpr double left = 96, right = 28, top = 104, bottom = 66;

  PagePoint place(double x, double y) const {
    return {left + share(chart_.x, x) * width_, top + (1.0 - share(chart_.y, y)) * height_};
  }
  void line(PagePoint a, PagePoint b, const Stroke& stroke) {
    pen_.lines({{a, b}}, stroke, {0, 0}, chart_.width_px, chart_.height_px);
  }

  void axes() {
    const double base = top + height_;
    for (const ChartTick& tick : chart_.x.ticks) {
      const double x = left + share(chart_.x, tick.at) * width_;
      if (!tick.label.empty()) {
        line({x, top}, {x, base}, {grid_colour, 1.0});
        pen_.text({x, base + 24}, tick.label,
                  {.size_px = 14, .colour = ink, .anchor = Anchor::middle});
      }
      line({x, base}, {x, base + (tick.label.empty() ? 4 : 7)}, {ink, 1.2});
    }
    for (const ChartTick& tick : chart_.y.ticks) {
      const double y = top + (1.0 - share(chart_.y, tick.at)) * height_;
      if (!tick.label.empty()) {
        line({left, y}, {left + width_, y}, {grid_colour, 1.0});
        pen_.text({left - 12, y + 5}, tick.label,
                  {.size_px = 14, .colour = ink, .anchor = Anchor::end});
      }
      line({left - (tick.label.empty() ? 4 : 7), y}, {left, y}, {ink, 1.2});
    }
    pen_.text({left + 0.5 * width_, chart_.height_px - 16.0}, chart_.x.label,
              {.size_px = 16, .colour = ink, .anchor = Anchor::middle});
    pen_.text({26, top + 0.5 * height_}, chart_.y.label,
              {.size_px = 16, .colour = ink, .anchor = Anchor::middle, .upwards = true});
  }

  void lines(const ChartSeries& series) {
    std::vector<std::vector<PagePoint>> all;
    all.reserve(series.lines.size());
    for (const auto& points : series.lines) {
      std::vector<PagePoint> on_page;
      for (const ChartPoint& p : points) on_page.push_back(place(p.x, p.y));
      if (on_page.size() == 1) on_page.push_back({on_page[0].x_px + 0.7, on_page[0].y_px});
      all.push_back(simplified(on_page));
    }
    // The more lines, the fainter each, so that lines below remain visible.
    const double opacity = std::clamp(30.0 / std::sqrt(double(all.size()) + 1), 0.3, 1.0);
    pen_.lines(all, {series.colour, 1.0, opacity}, {left, top}, width_, height_);
  }

  void frame() {
    const double r = left + width_, b = top + height_;
    pen_.lines({{{left, top}, {r, top}, {r, b}, {left, b}, {left, top}}}, {ink, 1.4}, {0, 0},
               chart_.width_px, chart_.height_px);
  }

  void legend() {
    constexpr double size = 14, gap = 26;
    double x = left;
    const double y = 86;
    for (const ChartSeries& s : chart_.series) {
      pen_.rectangle({x, y - 8}, 22, 5, s.colour);
      pen_.text({x + 29, y}, s.label, {.size_px = size, .colour = ink});
      x += 29 + pen_.text_width_px(s.label, size) + gap;
    }
    if (chart_.bands.empty()) return;
    pen_.rectangle({x, y - 13}, 22, 15, band_colour);
    pen_.text({x + 29, y}, chart_.bands_label, {.size_px = size, .colour = ink});
  }

  const Chart& chart_;
  ChartPen& pen_;
  double width_ = chart_.width_px - left - right, height_ = chart_.height_px - top - bottom;
};

/// "20,000"
std::string grouped(double value) {
  const std::string digits = std::to_string(std::llround(value));
  std::string out;
  for (std::size_t k = 0; k < digits.size(); ++k) {
    if (k > 0 && (digits.size() - k) % 3 == 0) out += ',';
    out += digits[k];
  }
  return out;
}

}  // namespace

void draw_chart(const Chart& chart, ChartPen& pen) { Page(chart, pen).draw(); }

std::vector<ChartTick> logarithmic_ticks(double least, double most) {
  std::vector<ChartTick> ticks;
  for (int power = int(std::floor(std::log10(least))); std::pow(10.0, power) <= most; ++power)
    for (int k = 1; k <= 9; ++k) {
      const double at = k * std::pow(10.0, power);
      if (at < least * (1 - 1e-9) || at > most * (1 + 1e-9)) continue;
      const bool named = k == 1 || k == 2 || k == 5;
      ticks.push_back({at, !named ? "" : at >= 1 ? grouped(at) : formatted("%g", at)});
    }
  return ticks;
}

ChartAxis logarithmic_axis(std::string label, double least, double most) {
  return {.label = std::move(label),
          .least = least,
          .most = most,
          .logarithmic = true,
          .ticks = logarithmic_ticks(least, most)};
}

}  // namespace dmise
