// Prints pieces of breakups for tests/reference/breakup_laws.py: one line each of length, log10 of
// area-to-mass, area, mass, log10 of speed, direction; `explosion` or `collision`.
#include <cmath>
#include <cstdio>
#include <string>

#include "core/orbit/breakup/breakup_model.h"

int main(int count, char** words) {
  using namespace dmise;
  const bool collides = count > 1 && std::string(words[1]) == "collision";
  BreakupEvent event{.mass_kg = 1e6, .scale = 8.0, .min_length_m = 0.02};
  if (collides)
    event = {.kind = BreakupKind::collision,
             .structure = BrokenStructure::spacecraft,
             .mass_kg = 900.0,
             .projectile_mass_kg = 556.0,
             .relative_speed_m_per_s = 11700.0,
             .min_length_m = 0.02};
  const DrawnPieces drawn = draw_pieces(event, 1, "breakup");
  std::printf("%d\n", drawn.too_heavy);
  for (const auto& p : drawn.pieces)
    std::printf("%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", p.length_m,
                std::log10(p.area_to_mass_m2_per_kg), p.area_m2, p.mass_kg,
                std::log10(p.speed_m_per_s), p.direction[0], p.direction[1], p.direction[2]);
}
