#pragma once
#include <cstdint>
#include <string>
#include <vector>

// NASA's standard breakup model: Johnson, Krisko, Liou & Anz-Meador 2001, Advances in Space
// Research 28, 1377 (equations 2 to 12).
namespace dmise {

enum class BreakupKind { explosion, collision };
enum class BrokenStructure { upper_stage, spacecraft };

/// What breaks, and how.
struct BreakupEvent {
  BreakupKind kind = BreakupKind::explosion;
  BrokenStructure structure = BrokenStructure::upper_stage;
  double mass_kg = 0.0;                 // the parent's, > 0
  double scale = 1.0;                   // S of an explosion, > 0
  double projectile_mass_kg = 0.0;      // in a collision, > 0
  double relative_speed_m_per_s = 0.0;  // in a collision, > 0
  double min_length_m = 0.1;            // characteristic length, > 0

  bool operator==(const BreakupEvent&) const = default;
};

/// Whether the projectile's energy is 40 J or more for each gram of the parent.
bool is_catastrophic(const BreakupEvent& event);

/// Mass that the pieces share [kg]: the parent's, with the projectile's in a collision.
double total_mass_kg(const BreakupEvent& event);

/// How many pieces have this length or more; not rounded. Explosion: 6 S L^-1.6. Collision: 0.1
/// M^0.75 L^-1.71, M the mass of both [kg], or, if it is not catastrophic, the projectile's mass
/// [kg] times the square of the speed [km/s] (Krisko 2011, Orbital Debris Quarterly News 15(4), 4).
double pieces_over(const BreakupEvent& event, double length_m);

/// log10 of the area-to-mass ratio [m^2/kg]: share * N(mean, sigma) + (1 - share) * N(other_mean,
/// other_sigma).
struct AreaToMassLaw {
  double share = 1.0;
  double mean = 0.0, sigma = 0.0;
  double other_mean = 0.0, other_sigma = 0.0;
};

/// The law of pieces over 0.11 m (equations 4 and 5), and of those below 0.08 m (6).
AreaToMassLaw law_of_large(BrokenStructure structure, double length_m);
AreaToMassLaw law_of_small(double length_m);

/// Chance that a piece follows the law of large ones: 0 to 0.08 m, 1 from 0.11 m, between them
/// linear in log10 of the length. The paper has a bridge there and does not state it.
double share_of_large(double length_m);

/// Mean cross-section of a piece [m^2] (equations 8 and 9).
double area_m2(double length_m);

/// log10 of the speed [m/s] that a piece gets is normal with this mean and 0.4 (equations 11, 12).
double mean_log_speed(BreakupKind kind, double log_area_to_mass);
inline constexpr double sigma_log_speed = 0.4;

struct BreakupPiece {
  double length_m = 0.0;
  double area_to_mass_m2_per_kg = 0.0;
  double area_m2 = 0.0;
  double mass_kg = 0.0;
  double speed_m_per_s = 0.0;  // relative to the parent
  double direction[3] = {};    // unit vector, isotropic
};

struct DrawnPieces {
  std::vector<BreakupPiece> pieces;  // by descending length
  int too_heavy = 0;                 // left out: with them the pieces weigh more than what broke
};

/// Draws the pieces: as many as `pieces_over` the least length, rounded down. The heaviest are left
/// out while all weigh more than `total_mass_kg`. BreakupPiece k of a stream is a function of
/// (seed, stream, k) alone.
DrawnPieces draw_pieces(const BreakupEvent& event, std::uint64_t seed, const std::string& stream);

}  // namespace dmise
