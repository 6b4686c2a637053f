#include "bench/validation/sky_brightness.h"

#include <algorithm>
#include <cmath>

#include "bench/validation/sky_tables.h"
#include "core/base/formatted.h"
#include "core/base/numeric/quantile.h"

namespace dmise {

SkyFigures figures_of(const SkyTable& table) {
  std::vector<double> differences;
  for (const SkyRow& row : table.rows)
    for (const auto& cell : row.cells)
      if (cell) differences.push_back(cell->difference_mag());
  SkyFigures f{.cells = differences.size()};
  if (differences.empty()) return f;
  f.median_mag = median_of(differences);
  double mean = 0.0, square = 0.0;
  for (const double d : differences) {
    mean += d / double(differences.size());
    f.worst_mag = std::max(f.worst_mag, std::abs(d));
  }
  for (const double d : differences) square += (d - mean) * (d - mean);
  if (differences.size() > 1) f.scatter_mag = std::sqrt(square / double(differences.size() - 1));
  return f;
}

std::vector<SkyTable> compare_sky() {
  std::vector<SkyTable> tables = night_sky_tables();
  for (auto& table : day_sky_tables()) tables.push_back(std::move(table));
  return tables;
}

std::string sky_section(const std::vector<SkyTable>& tables) {
  std::string text =
      "\n## Brightness of the sky\n\n"
      "Published figures are in the program (`bench/validation/*_sky_tables.cpp`). A cell has the "
      "published magnitude and, in brackets, "
      "published less predicted; above 0 the model is too bright. This does not show: single "
      "nights, clouds, city lights, "
      "polarisation, colours of the day sky, directions that are not listed.\n";
  for (const SkyTable& table : tables) {
    const SkyFigures f = figures_of(table);
    text += "\n### " + table.title + "\n\n" + table.about + "\n\n| " + table.rows_are + " |";
    for (const auto& column : table.columns) text += " " + column + " |";
    text += "\n|---|";
    for (std::size_t i = 0; i < table.columns.size(); ++i) text += "---|";
    for (const SkyRow& row : table.rows) {
      text += "\n| " + row.what + " |";
      for (const auto& cell : row.cells)
        text += cell ? formatted(" %.2f (%+.2f) |", cell->published_mag, cell->difference_mag())
                     : std::string(" |");
    }
    text += formatted("\n\n%zu figures: median %+.2f, scatter %.2f, worst %.2f mag", f.cells,
                      f.median_mag, f.scatter_mag, f.worst_mag);
    text += table.target_mag > 0.0 ? formatted(" (wanted: within %g).\n", table.target_mag) : ".\n";
  }
  return text;
}

}  // namespace dmise
