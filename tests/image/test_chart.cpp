#include "core/image/charts/chart.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/image/charts/chart_layout.h"

namespace dmise {
namespace {

Chart sample() {
  Chart chart;
  chart.title = "Range & time <sunlit>";
  chart.x = {
      .label = "Time [h]", .least = 0, .most = 10, .ticks = {{0, "0"}, {5, "5"}, {10, "10"}}};
  chart.y = {.label = "Range [km]", .least = 100, .most = 10000, .logarithmic = true};
  chart.y.ticks = logarithmic_ticks(chart.y.least, chart.y.most);
  chart.series.push_back({"LEO", {0, 114, 178}, {{{2, 1000}, {8, 1000}}}});
  chart.width_px = 600;
  chart.height_px = 400;
  return chart;
}

/// Draws nothing and keeps what it was asked for.
struct Recorder : ChartPen {
  std::vector<std::vector<PagePoint>> all;
  std::vector<std::string> texts;
  void rectangle(PagePoint, double, double, Colour) override {}
  void lines(const std::vector<std::vector<PagePoint>>& lines, const Stroke&, PagePoint, double,
             double) override {
    all.insert(all.end(), lines.begin(), lines.end());
  }
  void text(PagePoint, const std::string& text, const TextStyle&) override {
    texts.push_back(text);
  }
  double text_width_px(const std::string&, double) const override { return 0.0; }
};

TEST(Chart, ALogarithmicAxisPutsItsGeometricMeanInTheMiddle) {
  Recorder pen;
  draw_chart(sample(), pen);
  // 1000 km is half way from 100 to 10,000; 2 h and 8 h are a fifth from either end.
  double top = 1e9, bottom = -1e9, left = 1e9, right = -1e9, y = 0, x1 = 0, x2 = 0;
  for (const auto& line : pen.all)
    if (line.size() == 5) {  // the frame
      for (const PagePoint& p : line) {
        top = std::min(top, p.y_px), bottom = std::max(bottom, p.y_px);
        left = std::min(left, p.x_px), right = std::max(right, p.x_px);
      }
    }
  for (const auto& line : pen.all)
    if (line.size() == 2 && line[0].x_px > left + 1 && line[1].x_px < right - 1 &&
        line[0].y_px == line[1].y_px)
      y = line[0].y_px, x1 = line[0].x_px, x2 = line[1].x_px;
  EXPECT_NEAR(y, 0.5 * (top + bottom), 1e-9);
  EXPECT_NEAR(x1 - left, 0.2 * (right - left), 1e-9);
  EXPECT_NEAR(right - x2, 0.2 * (right - left), 1e-9);
}

TEST(Chart, LogarithmicTicksAreNamedAtOneTwoAndFive) {
  std::string named;
  for (const ChartTick& t : logarithmic_ticks(300, 50000))
    if (!t.label.empty()) named += t.label + " ";
  EXPECT_EQ(named, "500 1,000 2,000 5,000 10,000 20,000 50,000 ");
}

TEST(Chart, ALineOfManyPointsIsDrawnWithFewWithinAThirdOfAPixel) {
  Chart chart = sample();
  chart.y.logarithmic = false;
  auto& line = chart.series[0].lines[0];
  line.clear();
  for (int k = 0; k <= 10000; ++k) line.push_back({k * 1e-3, 5000 + 3000 * std::sin(k * 1e-3)});
  Recorder pen;
  draw_chart(chart, pen);
  std::vector<PagePoint> drawn;
  for (const auto& l : pen.all)
    if (l.size() > drawn.size()) drawn = l;
  EXPECT_LT(drawn.size(), 100u);
  EXPECT_GT(drawn.size(), 10u);
  // Against the sine itself, in the page's coordinates.
  const double width = drawn.back().x_px - drawn.front().x_px;
  const auto y_of = [&](double hours) { return (5000 + 3000 * std::sin(hours) - 100) / 9900; };
  const double scale =
      (drawn[drawn.size() / 2].y_px - drawn.front().y_px) /
      (y_of(10 * (drawn[drawn.size() / 2].x_px - drawn.front().x_px) / width) - y_of(0));
  for (std::size_t k = 0; k + 1 < drawn.size(); ++k) {
    const double x = 0.5 * (drawn[k].x_px + drawn[k + 1].x_px) - drawn.front().x_px;
    const double y = 0.5 * (drawn[k].y_px + drawn[k + 1].y_px) - drawn.front().y_px;
    EXPECT_NEAR(y, scale * (y_of(10 * x / width) - y_of(0)), 0.5);
  }
}

TEST(Chart, SvgEscapesTextAndIsTheSameEachTime) {
  const std::string svg = chart_svg(sample());
  EXPECT_NE(svg.find("Range &amp; time &lt;sunlit&gt;"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg, chart_svg(sample()));
  EXPECT_EQ(svg.compare(svg.size() - 7, 7, "</svg>\n"), 0);
}

TEST(Chart, NothingToDrawIsAnEmptyChartNotAnError) {
  Chart chart = sample();
  chart.series.clear();
  EXPECT_FALSE(chart_svg(chart).empty());
}

}  // namespace
}  // namespace dmise
