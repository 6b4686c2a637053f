#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/orbit/breakup/breakup_model.h"
#include "core/orbit/elements/elements.h"
#include "core/orbit/motion_state.h"

namespace dmise {

inline constexpr int max_fragments = 100'000;

/// A parent object that has broken into pieces at or before the start of a run.
struct Breakup {
  std::string name;                // fragments are NAME-NUMBER, from 1, the longest first
  std::uint32_t first_number = 0;  // catalogue number of the first
  BreakupEvent event;
  std::optional<std::uint64_t> seed;  // none: the scenario's
  MotionState<Teme> parent;           // at the epoch
  Utc epoch;                          // when it broke up

  /// Numbers that its fragments may take: `pieces_over` the least length, rounded down.
  int fragment_count() const;
};

/// Fragments as a catalogue has them.
struct Fragments {
  std::vector<MeanElements> elements;
  std::vector<BreakupPiece> pieces;  // one for each of `elements`
  int too_heavy = 0;                 // left out, see `draw_pieces`
  int open = 0;                      // left out: they leave the Earth
  int no_path = 0;                   // left out: SGP4 has no orbit like theirs
  int decayed = 0;                   // left out: SGP4 has them enter the Earth before the start
  int falling = 0;                   // still in `elements`: the perigee is below the ground
};

/// Draws the pieces, adds their velocities to the parent's and fits element sets for SGP4 to the
/// states (`fit_elements_at`). B* is that of the drag of a cross-section with Cd = 2.2, and 0 for a
/// perigee below 156 km, where SGP4's drag is of no use. A breakup and a seed give the same bytes
/// anywhere.
Fragments fragments_of(const Breakup& breakup, std::uint64_t scenario_seed, const Utc& start);

/// One line: numbers, lengths and masses, and how many are left out for which reason.
std::string describe(const Breakup& breakup, const Fragments& fragments);

}  // namespace dmise
