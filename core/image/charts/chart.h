#pragma once
#include <string>
#include <vector>

#include "core/image/charts/drawing.h"

namespace dmise {

struct ChartPoint {
  double x = 0.0, y = 0.0;  // in the units of the axes
};

/// Lines of one kind, drawn in one colour.
struct ChartSeries {
  std::string label;  // in the legend
  Colour colour;
  std::vector<std::vector<ChartPoint>> lines;
};

struct ChartTick {
  double at = 0.0;
  std::string label;  // empty: a short tick without a grid line
};

struct ChartAxis {
  std::string label;
  double least = 0.0, most = 1.0;
  bool logarithmic = false;  // `least` > 0 then
  std::vector<ChartTick> ticks;
};

/// A range of the x axis shaded from top to bottom.
struct ChartBand {
  double from = 0.0, to = 0.0;
};

/// Line chart with two axes and a legend.
struct Chart {
  std::string title, subtitle;
  ChartAxis x, y;
  std::vector<ChartSeries> series;  // drawn in this order
  std::vector<ChartBand> bands;
  std::string bands_label;  // in the legend
  int width_px = 1400, height_px = 820;
};

/// Returns ticks of a logarithmic axis over [least, most], `least` > 0: 1, 2 and 5 times a power of
/// ten with labels such as "20,000", and short ones at the other multiples.
std::vector<ChartTick> logarithmic_ticks(double least, double most);
/// Returns the logarithmic axis over [least, most] with these ticks.
ChartAxis logarithmic_axis(std::string label, double least, double most);

/// Renders as SVG 1.1. Equal charts give equal text.
std::string chart_svg(const Chart& chart);

}  // namespace dmise
