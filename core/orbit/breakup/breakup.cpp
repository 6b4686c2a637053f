#include "core/orbit/breakup/breakup.h"

#include <algorithm>
#include <cmath>

#include "core/base/formatted.h"
#include "core/orbit/breakup/elements_at.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/orbit/sgp4/sgp4_terms.h"

namespace dmise {
namespace {

constexpr double drag_coefficient = 2.2;
// 12.741621 B* = Cd A / m (Vallado, Fundamentals of Astrodynamics, section 9.4.2).
constexpr double drag_of_bstar_m2_per_kg = 12.741621;
constexpr double min_perigee_with_drag_m = 156e3;
constexpr int looks = 32;  // at a path between the breakup and the start of the run

MotionState<Teme> pushed(const MotionState<Teme>& parent, const BreakupPiece& piece) {
  const auto& d = piece.direction;
  return {parent.position_m,
          parent.velocity_m_per_s + piece.speed_m_per_s * Vec<Teme>{d[0], d[1], d[2]}};
}

/// Height of the perigee of the conic through a state [m]; -infinity: none.
double perigee_height_m(const MotionState<Teme>& state) {
  const double gm = sgp4::mu_km3_per_s2 * 1e9;
  const Vec<Teme> h = cross(state.position_m, state.velocity_m_per_s);
  const double axis_inverse =
      2.0 / norm(state.position_m) - dot(state.velocity_m_per_s, state.velocity_m_per_s) / gm;
  const double p = dot(h, h) / gm, e = std::sqrt(std::max(0.0, 1.0 - p * axis_inverse));
  return p / (1.0 + e) - sgp4::earth_radius_m;
}

/// Whether SGP4 has a path of the object from its epoch to `minutes` later.
bool lasts(const Sgp4Batch& batch, std::size_t object, double minutes) {
  for (int k = 1; k <= looks; ++k)
    if (batch.propagate_one(object, minutes * k / looks).code != Sgp4Code::ok) return false;
  return true;
}

void keep_those_that_last(Fragments& all, const Utc& start) {
  if (all.elements.empty()) return;
  const Sgp4Batch batch(all.elements, nullptr, SimdLevel::sse2);
  const double minutes = batch.minutes_since_epoch(0, start.jd1, start.jd2);
  if (!(minutes > 0.0)) return;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < all.elements.size(); ++k) {
    if (!lasts(batch, k, minutes)) continue;
    all.elements[kept] = all.elements[k];
    all.pieces[kept++] = all.pieces[k];
  }
  all.decayed = int(all.elements.size() - kept);
  all.elements.resize(kept);
  all.pieces.resize(kept);
}

std::string length_text(double length_m) { return formatted("%.3g m", length_m); }

}  // namespace

int Breakup::fragment_count() const { return int(pieces_over(event, event.min_length_m)); }

Fragments fragments_of(const Breakup& breakup, std::uint64_t scenario_seed, const Utc& start) {
  DrawnPieces drawn =
      draw_pieces(breakup.event, breakup.seed.value_or(scenario_seed), breakup.name);
  Fragments all{.too_heavy = drawn.too_heavy};
  std::vector<MotionState<Teme>> states;
  std::vector<MeanElements> sets(drawn.pieces.size());
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const BreakupPiece& piece = drawn.pieces[k];
    states.push_back(pushed(breakup.parent, piece));
    if (perigee_height_m(states[k]) >= min_perigee_with_drag_m)
      sets[k].bstar_per_earth_radius =
          drag_coefficient * piece.area_to_mass_m2_per_kg / drag_of_bstar_m2_per_kg;
  }
  const auto faults = fit_elements_at(breakup.epoch, states, sets);
  for (std::size_t k = 0; k < sets.size(); ++k) {
    all.open += faults[k] == ElementsFault::open;
    all.no_path += faults[k] == ElementsFault::no_path;
    if (faults[k] != ElementsFault::none) continue;
    all.elements.push_back(sets[k]);
    all.pieces.push_back(drawn.pieces[k]);
  }
  keep_those_that_last(all, start);
  const int digits = int(std::to_string(breakup.fragment_count()).size());
  for (std::size_t k = 0; k < all.elements.size(); ++k) {
    MeanElements& e = all.elements[k];
    e.catalogue_number = breakup.first_number + std::uint32_t(k);
    e.name = breakup.name + formatted("-%0*d", digits, int(k) + 1);
    const double axis = std::pow(sgp4::xke / e.mean_motion_rad_per_min, 2.0 / 3.0);
    all.falling += axis * (1.0 - e.eccentricity) < 1.0;
  }
  return all;
}

std::string describe(const Breakup& breakup, const Fragments& fragments) {
  const auto& [elements, pieces, too_heavy, open, no_path, decayed, falling] = fragments;
  double mass_kg = 0.0;
  for (const BreakupPiece& piece : pieces) mass_kg += piece.mass_kg;
  std::string text = breakup.name + ": " + std::to_string(pieces.size()) + " fragments";
  if (!pieces.empty())
    text += " of " + length_text(pieces.back().length_m) + " to " +
            length_text(pieces.front().length_m) + " (median " +
            length_text(pieces[pieces.size() / 2].length_m) + ")";
  text += formatted(", %.4g of %.4g kg", mass_kg, total_mass_kg(breakup.event));
  if (breakup.event.kind == BreakupKind::collision)
    text += is_catastrophic(breakup.event) ? ", catastrophic collision"
                                           : ", collision that is not catastrophic";
  const auto add = [&](int count, const char* what) {
    if (count > 0) text += "; " + std::to_string(count) + what;
  };
  add(falling, " have a perigee below the ground");
  add(open, " left out: they leave the Earth");
  add(too_heavy, " left out: with them the pieces weigh more than what broke");
  add(decayed, " left out: they enter the Earth before the start");
  add(no_path, " left out: SGP4 has no orbit like theirs");
  return text;
}

}  // namespace dmise
