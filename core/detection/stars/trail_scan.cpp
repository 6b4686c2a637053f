#include "core/detection/stars/trail_scan.h"

#include <algorithm>
#include <cmath>

#include "core/detection/pixels/components.h"
#include "core/detection/pixels/filtered_frame.h"

namespace dmise {
namespace {

constexpr double max_outside = 0.35;   // from the frame's edge to a middle beyond, over the length
constexpr int step_px = 2;             // between the places of a scan
constexpr int same_trail = 16;         // steps in which trails hardly differ
constexpr double min_read_px = 8.0;    // shorter trails are read as far
constexpr int longest_read_px = 4000;  // longer ones would take the search beyond its bound

/// The nearest pixel of a coordinate above -65536, faster than std::lround.
int nearest(double px) { return int(px + 65536.5) - 65536; }

int samples_of(const Trail& t) { return int(std::round(std::max(t.length_px, min_read_px))); }

/// Variances of sums of 0, 1, .. pixels of a filtered frame along a line, in that of one pixel.
std::vector<double> variances_of_sums(int most, double sigma_px) {
  const FilteredFrame frame(1, 1, sigma_px);
  std::vector<double> out = {1.0};
  for (int n = 1; n <= most; ++n) out.push_back(n * frame.sum_variance(1.0, n));
  return out;
}

}  // namespace

TrailScan::TrailScan(const Scene& scene, const ResidualFrame& residual)
    : scene_(scene),
      residual_(residual),
      longest_px_(scene.stars.longest_trail_px()),
      variance_(variances_of_sums(longest_read_px, scene.sigma_px)) {
  for (const PixelPosition& t : scene.stars.trails_over_frame()) {
    beside_px_.x_px = std::max(beside_px_.x_px, max_outside * std::abs(t.x_px));
    beside_px_.y_px = std::max(beside_px_.y_px, max_outside * std::abs(t.y_px));
  }
}

double TrailScan::score_at(double x, double y, const Trail& t) const {
  if (t.length_px > longest_read_px) return 0.0;
  const int samples = samples_of(t);
  const double ux = std::cos(t.angle_rad), uy = std::sin(t.angle_rad);
  std::array<double, 4> sum{};
  std::array<int, 4> count{};
  for (int i = 0; i < samples; ++i) {
    const double along = ((i + 0.5) / samples - 0.5) * t.length_px;
    const int px = nearest(x + along * ux), py = nearest(y + along * uy);
    if (!scene_.contains(px, py)) continue;
    const auto quarter = std::size_t(4 * i / samples);
    sum[quarter] += double(residual_.snr().at(px, py));
    ++count[quarter];
  }
  return score_of(sum, count, samples);
}

/// Scores a trail by the sums over its quarters.
double TrailScan::score_of(const std::array<double, 4>& sum, const std::array<int, 4>& count,
                           int samples) const {
  double total = 0.0, most = 0.0;
  int all = 0, seen = 0, brightest = 0;
  for (std::size_t q = 0; q < 4; ++q) {
    total += sum[q];
    all += count[q];
    if (8 * count[q] < samples) continue;
    ++seen;
    const double mean = sum[q] / count[q];
    if (mean > most) most = mean, brightest = int(q);
  }
  if (10 * all < 4 * samples) return 0.0;
  if (seen >= 3) {
    total -= sum[std::size_t(brightest)];
    const int kept = all - count[std::size_t(brightest)];
    total *= std::sqrt(double(all) / kept);
    all = kept;
  }
  return total / std::sqrt(variance_[std::size_t(all)]);
}

/// Scores of places that follow each other by the scan's step and have the same trail.
void TrailScan::score_row(double x, double y, const Trail& t, std::span<float> scores) const {
  const double reach_px = t.length_px / 2 + 1;
  const double last_x = x + double(scores.size()) * step_px;
  const double inside_px =
      std::min({x, y, scene_.counts.columns - 1 - last_x, scene_.counts.rows - 1 - y});
  if (inside_px <= reach_px || t.length_px > longest_read_px) {
    for (std::size_t k = 0; k < scores.size(); ++k)
      scores[k] = float(score_at(x + double(k) * step_px, y, t));
    return;
  }
  const int samples = samples_of(t);
  const double ux = std::cos(t.angle_rad), uy = std::sin(t.angle_rad);
  std::array<std::array<float, same_trail>, 4> sums{};
  std::array<int, 4> count{};
  for (int i = 0; i < samples; ++i) {
    const double along = ((i + 0.5) / samples - 0.5) * t.length_px;
    const float* snr = &residual_.snr().at(nearest(x + along * ux), nearest(y + along * uy));
    const auto quarter = std::size_t(4 * i / samples);
    for (std::size_t k = 0; k < scores.size(); ++k)
      sums[quarter][k] += snr[k * std::size_t(step_px)];
    ++count[quarter];
  }
  for (std::size_t k = 0; k < scores.size(); ++k) {
    const std::array<double, 4> sum{sums[0][k], sums[1][k], sums[2][k], sums[3][k]};
    scores[k] = float(score_of(sum, count, samples));
  }
}

double TrailScan::reads_of_peaks() const {
  const double px = (scene_.counts.columns + 2 * beside_px_.x_px) *
                    (scene_.counts.rows + 2 * beside_px_.y_px) / (step_px * step_px);
  return px * std::max(min_read_px, longest_px_);
}

std::vector<TrailPlace> TrailScan::peaks(double min_snr) const {
  constexpr double by_steps = 0.8;  // least share of a peak's score at the scan's nearest place
  const double left = -beside_px_.x_px, top = -beside_px_.y_px;
  const int wide = int((scene_.counts.columns - 2 * left) / step_px) + 1,
            high = int((scene_.counts.rows - 2 * top) / step_px) + 1;
  std::vector<float> scores(std::size_t(wide) * std::size_t(high));
  const auto row = [&](int j) { return scores.data() + std::size_t(j) * std::size_t(wide); };
  for (int j = 0; j < high; ++j)
    for (int i = 0; i < wide; i += same_trail) {
      const double x = left + i * step_px, y = top + j * step_px;
      const Trail t = scene_.star_trail(x + same_trail / 2 * step_px, y);
      score_row(x, y, t, {row(j) + i, std::size_t(std::min(same_trail, wide - i))});
    }
  const auto least = float(by_steps * min_snr);
  std::vector<TrailPlace> places;
  for (int j = 0; j < high; ++j)
    for (int i = 0; i < wide; ++i) {
      const float here = row(j)[i];
      if (!(here >= least)) continue;
      bool highest = true;
      for (int y = std::max(j - 1, 0); y <= std::min(j + 1, high - 1); ++y)
        for (int x = std::max(i - 1, 0); x <= std::min(i + 1, wide - 1); ++x)
          highest &= row(y)[x] <= here;
      if (highest)
        places.push_back(
            {.score = double(here), .x_px = left + i * step_px, .y_px = top + j * step_px});
    }
  return places;
}

double TrailScan::climb(TrailPlace& place) const {
  constexpr int max_steps = 40;
  constexpr std::array<std::array<double, 2>, 6> moves = {
      {{1, 0}, {-1, 0}, {0, 0.7}, {0, -0.7}, {3, 0}, {-3, 0}}};
  const auto score = [&](double x, double y) { return score_at(x, y, scene_.star_trail(x, y)); };
  place.score = score(place.x_px, place.y_px);
  const double angle = scene_.star_trail(place.x_px, place.y_px).angle_rad;
  const double c = std::cos(angle), s = std::sin(angle);
  int steps = 0;
  while (steps < max_steps) {
    ++steps;
    TrailPlace best = place;
    for (const auto& [along, across] : moves) {
      const double x = place.x_px + along * c - across * s;
      const double y = place.y_px + along * s + across * c;
      const double there = score(x, y);
      if (there > best.score) best.score = there, best.x_px = x, best.y_px = y;
    }
    if (!(best.score > place.score)) break;
    place = best;
  }
  return steps * double(moves.size()) * std::max(min_read_px, longest_px_);
}

TrailScan::Part TrailScan::part_of(const Trail& t, double from_px, double to_px) const {
  Part out;
  for (double along = from_px + 0.5; along < to_px; along += 1.0) {
    const auto [x, y] = t.at(along);
    const int px = int(std::lround(x)), py = int(std::lround(y));
    if (!scene_.contains(px, py) || !scene_.has_value(px, py)) continue;
    out.mean += double(residual_.snr().at(px, py));
    ++out.samples;
  }
  if (!out.samples) return out;
  out.mean /= out.samples;
  const auto known = std::min(std::size_t(out.samples), variance_.size() - 1);
  out.noise = std::sqrt(variance_[known]) / double(known);
  return out;
}

double TrailScan::filtered_sigma_px(const Trail& t) const {
  return std::hypot(scene_.psf.sigma_at({t.x_px, t.y_px}), scene_.sigma_px);
}

double TrailScan::level_of(const Trail& t) const {
  Trail at_origin = t;
  at_origin.x_px = at_origin.y_px = 0.0;
  return trail_value(at_origin, filtered_sigma_px(t), 0.0, 0.0) /
         (scene_.noise_e_at(t.x_px, t.y_px) * std::sqrt(kernel_square_sum(scene_.sigma_px)));
}

}  // namespace dmise
