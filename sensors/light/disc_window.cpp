#include "sensors/light/disc_window.h"

#include <algorithm>
#include <cmath>

#include "core/optics/projection.h"
#include "sensors/scene/even_tile.h"

namespace dmise {
namespace {

int kind(double radiance) { return radiance < 0.0 ? 0 : radiance == 0.0 ? 1 : 2; }
/// Some are on the disc, or lit, and some are not.
bool on_edge(std::span<const double> looks) {
  return std::ranges::any_of(looks, [&](double r) { return kind(r) != kind(looks[0]); });
}

}  // namespace

DiscWindow::DiscWindow(const View& view, const Disc& disc, std::size_t times, Threads& threads)
    : view_(view), optics_(view.sensor().camera.optics), disc_(disc), threads_(threads) {
  window_.left = disc.box.left;
  window_.top = disc.box.top;
  window_.light = {disc.box.right - disc.box.left, disc.box.bottom - disc.box.top};
  // Enough for a round disc and, within limits, for the narrowest part; times share the samples.
  const double round = 16.0 / std::max(disc.radius_px, 1e-3);
  const double narrow = std::min(16.0 / std::max(disc.finest_px, 1e-3), 64.0);
  const double samples = std::clamp(std::max(round, narrow), 8.0, 256.0);
  samples_ = std::max(3, int(std::ceil(samples / std::sqrt(double(times)))));
}

void DiscWindow::add(SimTime t, double share) {
  const int rows = window_.light.rows;
  if (!view_.rolls()) return add_rows(t, share, 0, rows);
  for (int first = 0; first < rows; first += disc_.rows_together) {
    const int last = std::min(first + disc_.rows_together, rows);
    const double middle_px = window_.top + 0.5 * (first + last - 1);
    add_rows(t + view_.row_delay(middle_px), share, first, last);
  }
}

/// Adds to rows of the window, from the first to before the last, the disc of one time.
void DiscWindow::add_rows(SimTime t, double share, int first, int last) {
  const Radiance radiance = disc_.at(t);
  const auto gcrs_from_camera = view_.camera_from_gcrs(t).inverse();
  const Look look = [&](double x, double y) {
    const auto direction = unproject(optics_, {x, y});
    return direction ? radiance(gcrs_from_camera * *direction) : -1.0;
  };
  // Pixels of the window where the disc may be.
  const DiscBox box = disc_.box_at ? disc_.box_at(t) : disc_.box;
  const int left = std::max(0, box.left - window_.left);
  const int right = std::min(window_.light.columns, box.right - window_.left);
  const int top = std::max(first, box.top - window_.top);
  const int bottom = std::min(last, box.bottom - window_.top);
  if (left >= right || top >= bottom) return;
  threads_.for_ranges(std::size_t(bottom - top), tile_px, [&](std::size_t begin, std::size_t end) {
    for (int x = left; x < right; x += tile_px)
      add_tile(look, share, {x, top + int(begin), std::min(x + tile_px, right), top + int(end)});
  });
}

const ExtendedLight& DiscWindow::finish() {
  to_electrons(view_, window_, threads_);
  return window_;
}

/// Looks at 3 x 3 places of a tile of a large disc; where nothing happens between them the rest
/// follows from these to 0.1 %. Otherwise at the corners of all pixels.
void DiscWindow::add_tile(const Look& look, double share, const DiscBox& tile) {
  const double x = window_.left + tile.left - 0.5, y = window_.top + tile.top - 0.5;
  const double width = tile.right - tile.left, height = tile.bottom - tile.top;
  if (disc_.is_large) {
    double at[9];
    for (int k = 0; k < 9; ++k) at[k] = look(x + 0.5 * width * (k % 3), y + 0.5 * height * (k / 3));
    if (!on_edge(at) && kind(at[0]) < 2) return;
    if (!on_edge(at) && is_even(at)) {
      for (int j = tile.top; j < tile.bottom; ++j)
        for (int i = tile.left; i < tile.right; ++i)
          window_.light.at(i, j) += float(
              share * bilinear(at, (i + 0.5 - tile.left) / width, (j + 0.5 - tile.top) / height));
      return;
    }
  }
  add_pixels(look, share, tile);
}

void DiscWindow::add_pixels(const Look& look, double share, const DiscBox& tile) {
  const double x = window_.left + tile.left - 0.5, y = window_.top + tile.top - 0.5;
  const int columns = tile.right - tile.left;
  double rows[2][tile_px + 1];
  const auto fill = [&](double(&corners)[tile_px + 1], double at_y) {
    for (int i = 0; i <= columns; ++i) corners[i] = look(x + i, at_y);
  };
  fill(rows[0], y);
  for (int j = tile.top; j < tile.bottom; ++j) {
    const double(&above)[tile_px + 1] = rows[(j - tile.top) % 2];
    double(&below)[tile_px + 1] = rows[(j - tile.top + 1) % 2];
    fill(below, y + (j - tile.top + 1));
    for (int i = 0; i < columns; ++i) {
      const double corners[] = {above[i], above[i + 1], below[i], below[i + 1]};
      const double mean =
          disc_.changes_within_pixels || on_edge(corners)
              ? sampled(look, x + i + 0.5, y + (j - tile.top) + 0.5)
              : std::max(0.0, 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]));
      window_.light.at(tile.left + i, j) += float(share * mean);
    }
  }
}

double DiscWindow::sampled(const Look& look, double x, double y) const {
  double sum = 0.0;
  for (int j = 0; j < samples_; ++j)
    for (int i = 0; i < samples_; ++i)
      sum += std::max(0.0, look(x - 0.5 + (i + 0.5) / samples_, y - 0.5 + (j + 0.5) / samples_));
  return sum / (double(samples_) * samples_);
}

}  // namespace dmise
