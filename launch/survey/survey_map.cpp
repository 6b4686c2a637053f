#include "launch/survey/survey_map.h"

#include <array>
#include <cmath>
#include <optional>

#include "core/base/formatted.h"
#include "core/image/charts/chart_layout.h"
#include "launch/survey/coastlines.h"

namespace dmise {
namespace {

constexpr double cell_px = 8.0, margin_px = 52.0, head_px = 86.0, title_px = 30.0, gap_px = 46.0;
constexpr double panel_wide_px = map_columns * cell_px, panel_high_px = map_rows * cell_px;
constexpr int panels_across = 2;
constexpr Colour ink{40, 40, 40}, pale{120, 120, 120}, frame{190, 190, 190}, mark{213, 94, 0},
    coast{90, 90, 90};
constexpr Colour looked_at{235, 235, 235};

/// Detections in a cell from which on it has a colour: dark is many.
struct Class {
  double least;
  Colour colour;
  const char* label;
};
constexpr std::array<Class, 6> classes{{{0.5, {222, 235, 247}, "0.5"},
                                        {3, {189, 215, 231}, "3"},
                                        {10, {128, 177, 211}, "10"},
                                        {100, {66, 130, 190}, "100"},
                                        {1000, {20, 82, 150}, "1,000"},
                                        {10000, {8, 30, 80}, "10,000"}}};

const Colour& colour_of(double detections) {
  const Colour* colour = &looked_at;
  for (const Class& c : classes)
    if (detections >= c.least) colour = &c.colour;
  return *colour;
}

/// Shells with light in some frame, in their order.
std::vector<std::size_t> shown_shells(const SurveyMap& map) {
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < map.shells.size(); ++k)
    if (map.summaries[k].covered > 0) shown.push_back(k);
  return shown;
}

int height_of(std::size_t panels) {
  const std::size_t rows = (panels + panels_across - 1) / panels_across;
  return int(head_px + double(rows) * (panel_high_px + title_px + gap_px) + margin_px);
}
constexpr int width_px = int(2 * margin_px + panels_across * panel_wide_px + gap_px);

void draw_cells(const SurveyMap& map, std::size_t shell, PagePoint corner, ChartPen& pen) {
  for (int row = 0; row < map_rows; ++row) {
    const auto cell_colour = [&](int column) -> std::optional<Colour> {
      const auto found =
          map.cells.find({std::uint16_t(shell), std::uint16_t(row), std::uint16_t(column)});
      if (found == map.cells.end()) return std::nullopt;
      return colour_of(double(found->second.expected) * map_unit);
    };
    for (int column = 0; column < map_columns;) {
      const auto colour = cell_colour(column);
      int end = column + 1;  // neighbours of one colour are one rectangle
      while (end < map_columns && cell_colour(end) == colour) ++end;
      if (colour)
        pen.rectangle(
            {corner.x_px + column * cell_px, corner.y_px + (map_rows - 1 - row) * cell_px},
            (end - column) * cell_px, cell_px, *colour);
      column = end;
    }
  }
}

/// "60 W", "30 N", "0".
std::string degrees_text(int deg, const char* positive, const char* negative) {
  if (deg == 0) return "0";
  return std::to_string(std::abs(deg)) + (deg > 0 ? positive : negative);
}

PagePoint place_on(PagePoint corner, double longitude_deg, double latitude_deg) {
  return {corner.x_px + (longitude_deg + 180.0) / 360.0 * panel_wide_px,
          corner.y_px + (90.0 - latitude_deg) / 180.0 * panel_high_px};
}

void draw_coasts(PagePoint corner, ChartPen& pen) {
  std::vector<std::vector<PagePoint>> lines;
  for (const auto& line : coastlines()) {
    auto& drawn = lines.emplace_back();
    for (const CoastPoint& at : line)
      drawn.push_back(place_on(corner, 0.1 * at.longitude, 0.1 * at.latitude));
  }
  pen.lines(lines, {.colour = coast, .width_px = 0.8}, {0, 0}, width_px, 1e5);
}

void draw_panel(const SurveyMap& map, std::size_t shell, PagePoint corner, ChartPen& pen) {
  const ShellSummary& s = map.summaries[shell];
  pen.text({corner.x_px, corner.y_px - 9},
           formatted("%s: %.0f of %zu objects detected, %zu covered",
                     map.shells[shell].name.c_str(), s.detected, s.objects, s.covered),
           {.size_px = 15, .colour = ink});
  draw_cells(map, shell, corner, pen);
  std::vector<std::vector<PagePoint>> grid;
  for (int deg = -180; deg <= 180; deg += 60)
    grid.push_back({place_on(corner, deg, 90), place_on(corner, deg, -90)});
  for (int deg = -90; deg <= 90; deg += 30) {
    grid.push_back({place_on(corner, -180, deg), place_on(corner, 180, deg)});
    if (corner.x_px < 2 * margin_px)
      pen.text({corner.x_px - 6, place_on(corner, 0, deg).y_px + 4}, degrees_text(deg, " N", " S"),
               {.size_px = 11, .colour = pale, .anchor = Anchor::end});
  }
  pen.lines(grid, {.colour = frame, .width_px = 0.7}, {0, 0}, width_px, 1e5);
  draw_coasts(corner, pen);
  const double below_px = corner.y_px + panel_high_px;
  for (int deg = -180; deg <= 180; deg += 60)
    pen.text({place_on(corner, deg, 0).x_px, below_px + 14}, degrees_text(deg, " E", " W"),
             {.size_px = 11, .colour = pale, .anchor = Anchor::middle});
  pen.text({place_on(corner, 0, 0).x_px, below_px + 28}, "longitude [deg]",
           {.size_px = 11, .colour = pale, .anchor = Anchor::middle});
  if (corner.x_px < 2 * margin_px)
    pen.text({corner.x_px - 40, place_on(corner, 0, 0).y_px}, "latitude [deg]",
             {.size_px = 11, .colour = pale, .anchor = Anchor::middle, .upwards = true});
  for (const MapMark& site : map.sites) {
    const double east_deg = std::fmod(site.longitude_deg + 540.0, 360.0) - 180.0;
    const auto [x, y] = place_on(corner, east_deg, site.latitude_deg);
    pen.lines({{{x - 5, y}, {x + 5, y}}, {{x, y - 5}, {x, y + 5}}},
              {.colour = mark, .width_px = 2.0}, {0, 0}, width_px, 1e5);
  }
}

void draw_map(const SurveyMap& map, ChartPen& pen) {
  pen.text({margin_px, 30}, map.title, {.size_px = 20, .colour = ink});
  pen.text({margin_px, 50}, map.subtitle, {.size_px = 13, .colour = pale});
  double x = margin_px;
  const auto key = [&](Colour colour, const std::string& label) {
    pen.rectangle({x, 60}, 14, 12, colour);
    pen.text({x + 18, 71}, label, {.size_px = 12, .colour = pale});
    x += 30 + pen.text_width_px(label, 12);
  };
  key(looked_at, "sunlit in a field");
  for (const Class& c : classes) key(c.colour, std::string(c.label) + "+");
  pen.text({x, 71}, "detections in a cell of 5 deg under the objects; crosses: sites",
           {.size_px = 12, .colour = pale});
  const auto shown = shown_shells(map);
  if (shown.empty())
    pen.text({margin_px, head_px + 30}, "No sunlit object was in a field.",
             {.size_px = 15, .colour = ink});
  for (std::size_t k = 0; k < shown.size(); ++k)
    draw_panel(
        map, shown[k],
        {margin_px + double(k % panels_across) * (panel_wide_px + gap_px),
         head_px + title_px + double(k / panels_across) * (panel_high_px + title_px + gap_px)},
        pen);
}

}  // namespace

std::string map_svg(const SurveyMap& map) {
  return drawn_svg(width_px, height_of(shown_shells(map).size()),
                   [&](ChartPen& pen) { draw_map(map, pen); });
}

}  // namespace dmise
