#pragma once
#include <optional>
#include <string>
#include <vector>

namespace dmise {

/// A published brightness of the sky beside the predicted, magnitudes of either surface
/// brightness or illuminance.
struct SkyCell {
  double published_mag = 0.0, predicted_mag = 0.0;
  double difference_mag() const { return published_mag - predicted_mag; }  // > 0: model too bright
};

struct SkyRow {
  std::string what;
  std::vector<std::optional<SkyCell>> cells;  // by column; none: not published
};

/// What is compared of one source of light.
struct SkyTable {
  std::string name, title, about;  // `about`: sources, assumptions and what it does not show
  std::string rows_are;
  std::vector<std::string> columns;
  std::vector<SkyRow> rows;
  double target_mag = 0.0;  // greatest allowed difference; 0: none is asked for
};

struct SkyFigures {
  std::size_t cells = 0;
  double median_mag = 0.0, scatter_mag = 0.0;  // differences of all cells
  double worst_mag = 0.0;                      // the largest, without sign
};

SkyFigures figures_of(const SkyTable& table);

/// Tables of the dark, moonlit, twilight and day sky. Published figures are in the code.
std::vector<SkyTable> compare_sky();

/// Their section of the page in Markdown.
std::string sky_section(const std::vector<SkyTable>& tables);

}  // namespace dmise
