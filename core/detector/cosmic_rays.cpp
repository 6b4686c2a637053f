#include "core/detector/cosmic_rays.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/detector/detector.h"
#include "core/detector/noise/poisson.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

// Appends to `cuts` the fractions of a track from `from` to `from` + `extent` on one axis at which
// it crosses pixel borders of that axis.
void add_crossings(double from, double extent, std::vector<double>& cuts) {
  if (extent == 0.0) return;
  const double low = std::min(from, from + extent), high = std::max(from, from + extent);
  for (double border = std::ceil(low - 0.5) + 0.5; border < high; border += 1.0)
    cuts.push_back((border - from) / extent);
}

}  // namespace

double CosmicRays::cost_s(int level, const PlanFacts& f) { return level * 0.005e-9 * f.pixels(); }

std::span<const ParameterOf<CosmicRays>> CosmicRays::parameters() {
  static constexpr ParameterOf<CosmicRays> table[] = {
      {"cosmic_rays_per_px_s", "CRRATE", "[1/s/px] hits by charged particles",
       &CosmicRays::cosmic_rays_per_px_s, 0.0, 1e-3},
      {"cosmic_ray_e_per_px", "CRCHARGE", "[e-] left in a pixel pitch of track",
       &CosmicRays::cosmic_ray_e_per_px, 0.0, 1e6},
      {"cosmic_ray_depth_px", "CRDEPTH", "[px] depth of the sensitive layer",
       &CosmicRays::cosmic_ray_depth_px, 0.0, 100.0, true}};
  return table;
}

CosmicRays::Prepared CosmicRays::charges(int columns, int rows, double exposure_s,
                                         const RngKey& key) const {
  Prepared charges;
  const auto mean = float(cosmic_rays_per_px_s * exposure_s * columns * double(rows));
  float hits;
  poisson(key, 0, &mean, 1, &hits);
  std::vector<double> cuts;
  for (std::uint32_t hit = 1; hit <= std::uint32_t(hits); ++hit) {
    const auto u = [&](std::uint32_t draw) { return uniform_of(rng_word(key, hit, draw)); };
    const double x = u(1) * columns - 0.5, y = u(2) * rows - 0.5;
    // Flux through a plane goes with cos(theta): the cosine is the root of a uniform number.
    const double cosine = std::sqrt(u(3));
    const double across = std::min(cosmic_ray_depth_px * std::sqrt(1 - cosine * cosine) / cosine,
                                   std::hypot(columns, rows));
    const double dx = across * std::cos(2 * pi * u(4)), dy = across * std::sin(2 * pi * u(4));
    const auto time = float(u(5));
    const double charge = std::hypot(across, cosmic_ray_depth_px) * cosmic_ray_e_per_px;
    cuts.assign({0.0, 1.0});
    add_crossings(x, dx, cuts);
    add_crossings(y, dy, cuts);
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double middle = 0.5 * (cuts[i] + cuts[i + 1]);
      const auto px = std::int64_t(std::floor(x + dx * middle + 0.5)),
                 py = std::int64_t(std::floor(y + dy * middle + 0.5));
      if (px < 0 || px >= columns || py < 0 || py >= rows) continue;
      charges.push_back(
          {std::uint32_t(py * columns + px), float(charge * (cuts[i + 1] - cuts[i])), time});
    }
  }
  std::ranges::stable_sort(charges, {}, &CosmicCharge::pixel);
  return charges;
}

CosmicRays::Prepared CosmicRays::prepare(const ExposureFacts& exposed) const {
  const double exposure_s = exposed.exposure.exposure_s;
  const double hits = cosmic_rays_per_px_s * exposure_s * double(exposed.light.pixels.size());
  if (hits > max_cosmic_hits)
    throw Error("detector.cosmic_rays_per_px_s: an exposure must expect <= 1e7 hits, got " +
                std::to_string(hits));
  return charges(exposed.light.columns, exposed.light.rows, exposure_s, exposed.key);
}

void CosmicRays::apply(const ExposureFacts&, const Prepared& charges, Piece& piece) const {
  auto it = std::ranges::lower_bound(charges, piece.first, {}, &CosmicCharge::pixel);
  for (; it != charges.end() && it->pixel - piece.first < piece.electrons.size(); ++it) {
    piece.electrons[it->pixel - piece.first] += it->electrons;
    if (!piece.flags.empty()) piece.flags[it->pixel - piece.first] |= flag_cosmic_ray;
  }
}

}  // namespace dmise
