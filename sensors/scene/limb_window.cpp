#include "sensors/scene/limb_window.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/optics/projection.h"
#include "sensors/scene/even_tile.h"

namespace dmise {
namespace {

/// A pixel whose corners' lines differ by more than this in height over the ground is sampled, at
/// least twice per this height.
constexpr double fine_m = 1e3;
/// Even lattices of so many places in a square, k / places and k x step / places: Fibonacci's, in
/// which no two places share a row, a column or nearly any other line. Source: Niederreiter 1992,
/// Random Number Generation and Quasi-Monte Carlo Methods, chapter 5.
struct Lattice {
  int places, step;
};
constexpr std::array<Lattice, 7> lattices{
    {{8, 5}, {13, 8}, {21, 13}, {34, 21}, {55, 34}, {89, 55}, {144, 89}}};
/// Fewest places in a pixel on the edge of the ground.
constexpr double places_at_ground = 55.0;
/// A tile over the ground whose lines differ by less may be even.
constexpr double even_m = 4e3;

}  // namespace

LimbWindow::LimbWindow(const View& view, int margin_px, Source source, Threads& threads)
    : view_(view),
      optics_(view.sensor().camera.optics),
      source_(std::move(source)),
      threads_(threads) {
  const DiscBox box = frame_and_margin(view, margin_px);
  window_.left = box.left;
  window_.top = box.top;
  window_.light = {box.right - box.left, box.bottom - box.top};
}

std::vector<SimTime> LimbWindow::times() const {
  // Layers are 8.6 km wide.
  constexpr int most = 8;
  constexpr double step_m = 4e3;
  const FrameTimes& times = view_.times();
  const auto down = [&](SimTime t) {
    return view_.camera_from_gcrs(t) * -unit(view_.observer(t).position_m);
  };
  const double away_m = norm(view_.observer(times.middle).position_m);
  const double moves_m = away_m * angle_rad(down(times.start), down(times.end));
  const int count = std::clamp(int(std::ceil(moves_m / step_m)), 1, most);
  std::vector<SimTime> drawn;
  for (int i = 0; i < count; ++i) drawn.push_back(times.at((i + 0.5) / count));
  return drawn;
}

LimbWindow::Row LimbWindow::row_at(SimTime t, int row) const {
  const SimTime at = view_.rolls() ? t + view_.row_delay(std::clamp(row, 0, optics_.rows - 1)) : t;
  return {LimbSight(view_.observer(at).position_m, view_.surface()),
          view_.camera_from_gcrs(at).inverse()};
}

LimbWindow::Look LimbWindow::look(const Row& row, double x_px, double y_px) const {
  const auto at = unproject(optics_, {x_px, y_px});
  if (!at) return {std::numeric_limits<double>::infinity(), 0.0, false};
  const Vec<Gcrs> direction = row.gcrs_from_camera * *at;
  const LimbLine line = row.sight.line(direction);
  const double height_m = line.lowest_height_m();
  const bool shines = height_m < source_.top_m && (source_.before_ground || height_m > 0.0);
  return {height_m, shines ? source_.light(line, direction) : 0.0, true};
}

const ExtendedLight& LimbWindow::drawn() {
  const auto drawn_at = times();
  for (const SimTime t : drawn_at) add(t, 1.0f / float(drawn_at.size()));
  to_electrons(view_, window_, threads_);
  return window_;
}

void LimbWindow::add(SimTime t, float share) {
  const int columns = window_.light.columns, rows = window_.light.rows;
  std::vector<Row> of_rows;
  for (int y = 0; y < (view_.rolls() ? rows : 1); ++y)
    of_rows.push_back(row_at(t, window_.top + y));
  threads_.for_ranges(std::size_t(rows), tile_px, [&](std::size_t begin, std::size_t end) {
    for (int x = 0; x < columns; x += tile_px)
      add_tile(of_rows, share, {x, int(begin), std::min(x + tile_px, columns), int(end)});
  });
}

/// Looks at 3 x 3 places of a tile. Where all lines stay far above what shines there is none; where
/// nothing happens between the places the rest follows from these to 0.1 %.
void LimbWindow::add_tile(const std::vector<Row>& rows, float share, const DiscBox& tile) {
  const double x = window_.left + tile.left - 0.5, y = window_.top + tile.top - 0.5;
  const double width = tile.right - tile.left, height = tile.bottom - tile.top;
  double lowest_m = std::numeric_limits<double>::infinity(), highest_m = -lowest_m;
  double at[9];
  bool imaged = true;
  for (int k = 0; k < 9; ++k) {
    const int row = std::min(tile.bottom - 1, tile.top + int(0.5 * height * (k / 3)));
    const Look seen = look(of(rows, row), x + 0.5 * width * (k % 3), y + 0.5 * height * (k / 3));
    at[k] = seen.radiance;
    imaged = imaged && seen.imaged;
    if (!seen.imaged) continue;
    lowest_m = std::min(lowest_m, seen.height_m);
    highest_m = std::max(highest_m, seen.height_m);
  }
  const double spread_m = highest_m - lowest_m;
  if (imaged && lowest_m - spread_m > source_.top_m) return;
  const bool before_ground = imaged && highest_m + spread_m < 0.0;
  if (before_ground && !source_.before_ground) return;
  if (before_ground || (imaged && lowest_m - spread_m > 0.0 && spread_m < even_m)) {
    if (is_even(at)) {
      for (int j = tile.top; j < tile.bottom; ++j)
        for (int i = tile.left; i < tile.right; ++i)
          window_.light.at(i, j) += share * float(bilinear(at, (i + 0.5 - tile.left) / width,
                                                           (j + 0.5 - tile.top) / height));
      return;
    }
  }
  add_pixels(rows, share, tile);
}

void LimbWindow::add_pixels(const std::vector<Row>& rows, float share, const DiscBox& tile) {
  const double x = window_.left + tile.left - 0.5, y = window_.top + tile.top - 0.5;
  const int columns = tile.right - tile.left;
  std::array<std::array<Look, tile_px + 1>, 2> corners;
  const auto fill = [&](std::array<Look, tile_px + 1>& looks, const Row& row, double at_y) {
    for (int i = 0; i <= columns; ++i) looks[std::size_t(i)] = look(row, x + i, at_y);
  };
  for (int j = tile.top; j < tile.bottom; ++j) {
    const Row& row = of(rows, j);
    const double at_y = y + (j - tile.top);
    // A row of a rolling shutter shares no corners with the one before.
    auto& above = corners[std::size_t(j - tile.top) % 2];
    auto& below = corners[std::size_t(j - tile.top + 1) % 2];
    if (j == tile.top || rows.size() > 1) fill(above, row, at_y);
    fill(below, row, at_y + 1.0);
    for (int i = 0; i < columns; ++i) {
      const Look of_corners[] = {above[std::size_t(i)], above[std::size_t(i) + 1],
                                 below[std::size_t(i)], below[std::size_t(i) + 1]};
      double lowest_m = of_corners[0].height_m, highest_m = lowest_m, sum = 0.0;
      for (const Look& corner : of_corners) {
        lowest_m = std::min(lowest_m, corner.height_m);
        highest_m = std::max(highest_m, corner.height_m);
        sum += corner.radiance;
      }
      if (!std::isfinite(lowest_m)) continue;  // nothing is imaged
      const double spread_m = highest_m - lowest_m;
      if (lowest_m - spread_m > source_.top_m) continue;
      const bool before_ground = highest_m + spread_m < 0.0;
      if (before_ground && !source_.before_ground) continue;
      const bool on_edge = lowest_m < 0.0 && highest_m > 0.0;
      double mean = 0.25 * sum;
      if (!before_ground && (on_edge || spread_m > fine_m)) {
        const double places = std::max(2.0 * spread_m / fine_m, on_edge ? places_at_ground : 0.0) *
                              double(share);  // times share them
        mean = sampled(row, x + i + 0.5, at_y + 0.5, places);
      }
      window_.light.at(tile.left + i, j) += share * float(mean);
    }
  }
}

double LimbWindow::sampled(const Row& row, double x_px, double y_px, double min_places) const {
  const auto* lattice = lattices.begin();
  while (lattice + 1 != lattices.end() && lattice->places < min_places) ++lattice;
  double sum = 0.0;
  for (int k = 0; k < lattice->places; ++k) {
    const double across = (k + 0.5) / lattice->places;
    const double down = (k * lattice->step % lattice->places + 0.5) / lattice->places;
    sum += look(row, x_px - 0.5 + across, y_px - 0.5 + down).radiance;
  }
  return sum / lattice->places;
}

}  // namespace dmise
