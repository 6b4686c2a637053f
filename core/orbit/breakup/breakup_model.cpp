#include "core/orbit/breakup/breakup_model.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/base/numeric/rng.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double catastrophic_j_per_kg = 40e3;
constexpr double large_from_m = 0.11, small_to_m = 0.08;

/// `low` up to `from`, then with this slope, and `high` from `to`.
double ramp(double x, double from, double to, double low, double slope, double high) {
  return x <= from ? low : x >= to ? high : low + slope * (x - from);
}

double exponent_of(const BreakupEvent& event) {
  return event.kind == BreakupKind::explosion ? 1.6 : 1.71;
}

double draw_log_area_to_mass(const BreakupEvent& event, double length_m, std::uint32_t normal,
                             std::uint32_t component, std::uint32_t bridge) {
  const bool large = uniform_of(bridge) < share_of_large(length_m);
  const AreaToMassLaw law =
      large ? law_of_large(event.structure, length_m) : law_of_small(length_m);
  const bool first = uniform_of(component) < law.share;
  return (first ? law.mean : law.other_mean) +
         (first ? law.sigma : law.other_sigma) * double(normal_of(normal));
}

BreakupPiece draw_piece(const BreakupEvent& event, const RngKey& key, std::uint32_t k) {
  const auto word = [&](std::uint32_t draw) { return rng_word(key, k, draw); };
  BreakupPiece piece;
  piece.length_m = event.min_length_m * std::pow(uniform_of(word(0)), -1.0 / exponent_of(event));
  const double chi = draw_log_area_to_mass(event, piece.length_m, word(1), word(2), word(3));
  piece.area_to_mass_m2_per_kg = std::pow(10.0, chi);
  piece.area_m2 = area_m2(piece.length_m);
  piece.mass_kg = piece.area_m2 / piece.area_to_mass_m2_per_kg;
  piece.speed_m_per_s = std::pow(
      10.0, mean_log_speed(event.kind, chi) + sigma_log_speed * double(normal_of(word(4))));
  const double z = 2.0 * uniform_of(word(5)) - 1.0, turn = 2.0 * pi * uniform_of(word(6));
  const double across = std::sqrt((1.0 - z) * (1.0 + z));
  piece.direction[0] = across * std::cos(turn);
  piece.direction[1] = across * std::sin(turn);
  piece.direction[2] = z;
  return piece;
}

}  // namespace

bool is_catastrophic(const BreakupEvent& event) {
  const double speed = event.relative_speed_m_per_s;
  return 0.5 * event.projectile_mass_kg * speed * speed >= catastrophic_j_per_kg * event.mass_kg;
}

double total_mass_kg(const BreakupEvent& event) {
  return event.mass_kg + (event.kind == BreakupKind::collision ? event.projectile_mass_kg : 0.0);
}

double pieces_over(const BreakupEvent& event, double length_m) {
  if (event.kind == BreakupKind::explosion) return 6.0 * event.scale * std::pow(length_m, -1.6);
  const double speed_km_per_s = event.relative_speed_m_per_s * 1e-3;
  const double m = is_catastrophic(event)
                       ? total_mass_kg(event)
                       : event.projectile_mass_kg * speed_km_per_s * speed_km_per_s;
  return 0.1 * std::pow(m, 0.75) * std::pow(length_m, -1.71);
}

AreaToMassLaw law_of_large(BrokenStructure structure, double length_m) {
  const double x = std::log10(length_m);
  if (structure == BrokenStructure::upper_stage)
    return {.share = ramp(x, -1.4, 0.0, 1.0, -0.3571, 0.5),
            .mean = ramp(x, -0.5, 0.0, -0.45, -0.9, -0.9),
            .sigma = 0.55,
            .other_mean = -0.9,
            .other_sigma = ramp(x, -1.0, 0.1, 0.28, -0.1636, 0.1)};
  return {.share = x <= -1.95  ? 0.0
                   : x >= 0.55 ? 1.0
                               : 0.3 + 0.4 * (x + 1.2),
          .mean = ramp(x, -1.1, 0.0, -0.6, -0.318, -0.95),
          .sigma = ramp(x, -1.3, -0.3, 0.1, 0.2, 0.3),
          .other_mean = ramp(x, -0.7, -0.1, -1.2, -1.333, -2.0),
          .other_sigma = ramp(x, -0.5, -0.3, 0.5, -1.0, 0.3)};
}

AreaToMassLaw law_of_small(double length_m) {
  const double x = std::log10(length_m);
  return {.share = 1.0,
          .mean = ramp(x, -1.75, -1.25, -0.3, -1.4, -1.0),
          .sigma = x <= -3.5 ? 0.2 : 0.2 + 0.1333 * (x + 3.5)};
}

double share_of_large(double length_m) {
  const double low = std::log10(small_to_m), high = std::log10(large_from_m);
  return std::clamp((std::log10(length_m) - low) / (high - low), 0.0, 1.0);
}

double area_m2(double length_m) {
  return length_m < 0.00167 ? 0.540424 * length_m * length_m
                            : 0.556945 * std::pow(length_m, 2.0047077);
}

double mean_log_speed(BreakupKind kind, double log_area_to_mass) {
  return kind == BreakupKind::explosion ? 0.2 * log_area_to_mass + 1.85
                                        : 0.9 * log_area_to_mass + 2.9;
}

DrawnPieces draw_pieces(const BreakupEvent& event, std::uint64_t seed, const std::string& stream) {
  const RngKey key = rng_key(seed, stream, 0, "breakup");
  const auto count = std::uint32_t(pieces_over(event, event.min_length_m));
  DrawnPieces drawn;
  for (std::uint32_t k = 0; k < count; ++k) drawn.pieces.push_back(draw_piece(event, key, k));
  std::ranges::stable_sort(drawn.pieces, std::greater(), &BreakupPiece::mass_kg);
  double mass_kg = 0.0;
  for (std::size_t k = drawn.pieces.size(); k-- > 0;) {  // from the lightest
    mass_kg += drawn.pieces[k].mass_kg;
    if (mass_kg <= total_mass_kg(event)) continue;
    drawn.too_heavy = int(k) + 1;
    break;
  }
  drawn.pieces.erase(drawn.pieces.begin(), drawn.pieces.begin() + drawn.too_heavy);
  std::ranges::stable_sort(drawn.pieces, std::greater(), &BreakupPiece::length_m);
  return drawn;
}

}  // namespace dmise
