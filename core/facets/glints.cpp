#include "core/facets/glints.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

// A lobe is (1 - v / v0)^3, v the versine of the angle from the part's normal: smooth, 0 beyond
// the reach of versine v0, and its integral over the sphere is pi v0 / 2.
constexpr double versine_of_half_peak = 0.20629947401590026;  // 1 - 2^(-1/3), over v0

double lobe(double versine_over_reach) {
  const double rest = 1.0 - versine_over_reach;
  return rest > 0.0 ? rest * rest * rest : 0.0;
}

/// Mean over the sphere of a lobe about a plane, by its reach; Simpson's rule.
double mean_about_plane(double reach_rad) {
  constexpr int steps = 64;
  const double reach_versine = 1.0 - std::cos(reach_rad), step_rad = reach_rad / steps;
  double sum = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double at_rad = i * step_rad, weight = i == 0 || i == steps ? 1.0 : i % 2 ? 4.0 : 2.0;
    sum += weight * lobe((1.0 - std::cos(at_rad)) / reach_versine) * std::cos(at_rad);
  }
  return sum * step_rad / 3.0;
}

double reach_versine_of(double half_width_rad) {
  return (1.0 - std::cos(half_width_rad)) / versine_of_half_peak;
}

/// Number of parts where `mean` are expected: Poisson's, by the quantile of a uniform number.
int poisson_of(double uniform, double mean) {
  double probability = std::exp(-mean), below = probability;
  int count = 0;
  const int most = int(mean + 12.0 * std::sqrt(mean) + 24.0);
  while (uniform > below && count < most) {
    probability *= mean / ++count;
    below += probability;
  }
  return count;
}

}  // namespace

std::vector<GlintLobes> lobes_of(const Glints& glints) {
  const int octaves = int(std::lround(std::log2(glints.widest_rad / glints.narrowest_rad)));
  std::vector<GlintLobes> lobes;
  for (int i = 0; i <= octaves; ++i) {
    const double part = octaves > 0 ? double(i) / octaves : 0.0;
    const auto between = [&](double first, double last) {
      return first * std::pow(last / first, part);
    };
    lobes.push_back({between(glints.narrowest_rad, glints.widest_rad),
                     between(glints.share_of_narrowest, glints.share_of_widest)});
  }
  return lobes;
}

RngKey glint_key(std::uint64_t seed, std::string_view name, std::uint32_t catalogue_number) {
  return rng_key(seed, name, catalogue_number, Glints::facts.name);
}

Vec<Body> bisector_of(const Vec<Body>& to_sun, const Vec<Body>& to_viewer) {
  const Vec<Body> sum = to_sun + to_viewer;
  const double length = norm(sum);
  return length > 0.0 ? sum / length : Vec<Body>{};
}

GlintField::GlintField(const Glints& glints)
    : edges_(glints.edges), still_rad_(std::min(glints.narrowest_rad, 0.25 * deg)) {
  if (edges_) {
    still_rad_ = std::min(still_rad_, edges_->half_width_rad);
    edge_reach_versine_ = reach_versine_of(edges_->half_width_rad);
    edge_peak_ = edges_->share / mean_about_plane(std::acos(1.0 - edge_reach_versine_));
    smooth_share_ -= edges_->share;
  }
  for (const auto& [half_width_rad, share] : lobes_of(glints)) {
    Cells cells;
    cells.reach_versine = reach_versine_of(half_width_rad);
    cells.reach_rad = std::acos(1.0 - cells.reach_versine);
    // The mean of a lobe over the sphere is 1/4 of the part of it that the lobe reaches.
    cells.peak = 4.0 * share / glints.parts_in_view;
    cells.parts_per_sr = glints.parts_in_view / (2.0 * pi * cells.reach_versine);
    const int bands = std::max(1, int(pi / cells.reach_rad));
    cells.height_rad = pi / bands;
    cells.first = {0};
    for (int band = 0; band < bands; ++band) {
      const double around_rad = 2.0 * pi * std::sin((band + 0.5) * cells.height_rad);
      cells.first.push_back(cells.first.back() +
                            std::uint32_t(std::max(1.0, around_rad / cells.reach_rad)));
    }
    of_widths_.push_back(std::move(cells));
    smooth_share_ -= share;
  }
}

double GlintField::over_smooth(const RngKey& object, const Vec<Body>& to_sun,
                               const Vec<Body>& to_viewer) const {
  const Vec<Body> at = bisector_of(to_sun, to_viewer);
  if (at == Vec<Body>{}) return 1.0;
  double sum = smooth_share_ + light_of_edges(at);
  for (std::size_t i = 0; i < of_widths_.size(); ++i)
    sum += of_widths_[i].peak * sum_of_lobes(of_widths_[i], std::uint32_t(i), object, at);
  return sum;
}

double GlintField::light_of_edges(const Vec<Body>& at) const {
  if (!edges_) return 0.0;
  const double beside = dot(edges_->axis, at);  // sine of the angle from the plane across
  const double versine = 1.0 - std::sqrt(std::max(0.0, 1.0 - beside * beside));
  return edge_peak_ * lobe(versine / edge_reach_versine_);
}

double GlintField::sum_of_lobes(const Cells& cells, std::uint32_t width, const RngKey& object,
                                const Vec<Body>& at) const {
  const double from_pole_rad = std::acos(std::clamp(at.z, -1.0, 1.0));
  const double longitude_rad = std::atan2(at.y, at.x);
  const double lowest_rad = from_pole_rad - cells.reach_rad;
  const double highest_rad = from_pole_rad + cells.reach_rad;
  // Longitudes on either side; all of them where the reach holds a pole.
  double side_rad = pi;
  if (lowest_rad > 0.0 && highest_rad < pi)
    side_rad = std::asin(std::min(1.0, std::sin(cells.reach_rad) / std::sin(from_pole_rad)));
  const int bands = int(cells.first.size()) - 1;
  const int last_band = std::min(bands - 1, int(highest_rad / cells.height_rad));
  double sum = 0.0;
  for (int band = std::max(0, int(lowest_rad / cells.height_rad)); band <= last_band; ++band) {
    const std::uint32_t first = cells.first[std::size_t(band)];
    const int count = int(cells.first[std::size_t(band) + 1] - first);
    const double top = std::cos(band * cells.height_rad);
    const double bottom = std::cos((band + 1) * cells.height_rad);
    const double wide_rad = 2.0 * pi / count;
    const double mean = cells.parts_per_sr * (top - bottom) * wide_rad;
    int begin = int(std::floor((longitude_rad - side_rad) / wide_rad));
    int end = int(std::floor((longitude_rad + side_rad) / wide_rad));
    if (end - begin + 1 > count) end = begin + count - 1;
    for (int i = begin; i <= end; ++i) {
      const int column = (i % count + count) % count;
      const std::uint32_t cell = first + std::uint32_t(column);
      const std::uint32_t draw = width << 16;
      const int parts = poisson_of(uniform_of(rng_block(object, cell, draw)[0]), mean);
      for (int part = 0; part < parts; ++part) {
        const auto words = rng_block(object, cell, draw + 1 + std::uint32_t(part));
        const double z = bottom + (top - bottom) * uniform_of(words[0]);
        const double around_rad = (column + uniform_of(words[1])) * wide_rad;
        const double level = std::sqrt(1.0 - z * z);
        const Vec<Body> normal{level * std::cos(around_rad), level * std::sin(around_rad), z};
        const Vec<Body> apart = normal - at;  // its square is twice the versine
        sum += lobe(0.5 * dot(apart, apart) / cells.reach_versine);
      }
    }
  }
  return sum;
}

}  // namespace dmise
