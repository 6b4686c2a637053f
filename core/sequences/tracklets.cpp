#include "core/sequences/tracklets.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/units.h"
#include "core/detection/pixels/detection_limits.h"

namespace dmise {
namespace {

constexpr std::size_t max_points = 400;  // in a frame
constexpr double max_pairs = 2e7;        // pairs of points of all frames
constexpr double min_share = 0.4;        // frames that have a point on a motion, over all
constexpr double gate_widths = 1.0;      // FWHM between a point and a motion through two others

bool is_peak(const MovingSnr& snr, int x, int y) {
  const float here = snr.at(x, y);
  for (int v = -1; v <= 1; ++v)
    for (int u = -1; u <= 1; ++u) {
      const float other = snr.at(x + u, y + v);
      if (other > here || (other == here && (v < 0 || (v == 0 && u < 0)))) return false;
    }
  return true;
}

/// Offset of a parabola's top from the middle of three values, at most half a pixel.
double top_of(double before, double here, double after) {
  const double bend = 2 * here - before - after;
  return bend > 0 ? std::clamp((after - before) / (2 * bend), -0.5, 0.5) : 0.0;
}

struct Link {
  SkyMotion motion;
  std::vector<std::pair<std::size_t, std::size_t>> points;  // frame and index there
  double snr = 0.0;
};

using Points = std::vector<std::vector<MovingPoint>>;

/// Points of a frame in cells of the reference frame.
class PointGrid {
 public:
  PointGrid(const std::vector<MovingPoint>& points, double gate_px)
      : points_(points), gate_px_(gate_px) {
    for (std::size_t i = 0; i < points.size(); ++i)
      order_.emplace_back(cell(points[i].reference.y_px), points[i].reference.x_px, i);
    std::sort(order_.begin(), order_.end());
  }
  /// The nearest point within the gate; none: points.size().
  std::size_t nearest(PixelPosition at) const {
    std::size_t best = points_.size();
    double distance = gate_px_;
    for (long row = cell(at.y_px) - 1; row <= cell(at.y_px) + 1; ++row) {
      auto it = std::lower_bound(order_.begin(), order_.end(),
                                 std::tuple(row, at.x_px - gate_px_, std::size_t(0)));
      for (;
           it != order_.end() && std::get<0>(*it) == row && std::get<1>(*it) <= at.x_px + gate_px_;
           ++it) {
        const PixelPosition off = points_[std::get<2>(*it)].reference - at;
        const double d = std::hypot(off.x_px, off.y_px);
        if (d < distance) {
          distance = d;
          best = std::get<2>(*it);
        }
      }
    }
    return best;
  }

 private:
  long cell(double y_px) const { return std::lround(y_px / gate_px_); }

  const std::vector<MovingPoint>& points_;
  double gate_px_;
  std::vector<std::tuple<long, double, std::size_t>> order_;
};

class Linking {
 public:
  explicit Linking(const TrackScene& scene) : scene_(scene) {
    const double gate_px = gate_widths * fwhm_per_sigma * scene.sequence.sigma_px;
    const auto n = double(scene.light.size());
    const auto most = std::size_t(std::sqrt(2 * max_pairs / (n * (n - 1))));
    for (std::size_t i = 0; i < scene.light.size(); ++i) {
      points_.push_back(find_moving_points(scene.light[i], scene.registration, i));
      if (points_.back().size() > most) points_.back().resize(most);
    }
    for (const auto& points : points_) grids_.emplace_back(points, gate_px);
    min_points_ =
        std::max(min_sequence_frames, std::size_t(std::ceil(min_share * double(points_.size()))));
  }

  std::vector<Link> links() const {
    std::vector<Link> out;
    for (std::size_t i = 0; i < points_.size(); ++i)
      for (std::size_t j = i + 1; j < points_.size(); ++j)
        for (const MovingPoint& a : points_[i])
          for (const MovingPoint& b : points_[j]) add(i, j, a, b, out);
    std::stable_sort(out.begin(), out.end(), [](const Link& a, const Link& b) {
      return std::tuple(a.points.size(), a.snr) > std::tuple(b.points.size(), b.snr);
    });
    return out;
  }

 private:
  double time_s(std::size_t frame) const { return scene_.sequence.frames[frame].time_s; }

  void add(std::size_t i, std::size_t j, const MovingPoint& a, const MovingPoint& b,
           std::vector<Link>& out) const {
    const PixelPosition rate = (b.reference - a.reference) * (1 / (time_s(j) - time_s(i)));
    if (!scene_.range.has(rate)) return;
    Link link{.motion = {a.reference - rate * time_s(i), rate}};
    for (std::size_t k = 0; k < points_.size(); ++k)
      if (const std::size_t p = grids_[k].nearest(link.motion.at(time_s(k)));
          p < points_[k].size()) {
        link.points.emplace_back(k, p);
        link.snr += std::min(points_[k][p].snr, 20.0);
      }
    if (link.points.size() >= min_points_) out.push_back(std::move(link));
  }

  const TrackScene& scene_;
  Points points_;
  std::vector<PointGrid> grids_;
  std::size_t min_points_ = 3;
};

}  // namespace

std::vector<MovingPoint> find_moving_points(const MovingLight& light,
                                            const Registration& registration, std::size_t frame) {
  std::vector<MovingPoint> points;
  const MovingSnr& snr = light.snr;
  for (int y = 1; y + 1 < snr.rows; ++y)
    for (int x = 1; x + 1 < snr.columns; ++x) {
      const auto here = double(snr.at(x, y));
      if (here < detection_limits::seed_snr || !is_peak(snr, x, y)) continue;
      const PixelPosition at{x + top_of(double(snr.at(x - 1, y)), here, double(snr.at(x + 1, y))),
                             y + top_of(double(snr.at(x, y - 1)), here, double(snr.at(x, y + 1)))};
      points.push_back({at, {}, here});
    }
  std::stable_sort(points.begin(), points.end(),
                   [](const MovingPoint& a, const MovingPoint& b) { return a.snr > b.snr; });
  if (points.size() > max_points) points.resize(max_points);
  for (MovingPoint& point : points) point.reference = registration.in_reference(frame, point.place);
  return points;
}

std::vector<SkyMotion> link_points(const TrackScene& scene) {
  std::vector<SkyMotion> motions;
  std::vector<std::pair<std::size_t, std::size_t>> taken;
  for (const Link& link : Linking(scene).links()) {
    const auto free = std::ranges::count_if(
        link.points, [&](const auto& point) { return !std::ranges::binary_search(taken, point); });
    if (std::size_t(2 * free) < link.points.size() || free < 2) continue;
    motions.push_back(link.motion);
    taken.insert(taken.end(), link.points.begin(), link.points.end());
    std::sort(taken.begin(), taken.end());
  }
  return motions;
}

}  // namespace dmise
