#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// Trapped charge between two exposures. A frame depends on earlier frames only by this, and only
/// on those of the last 2 windows: frame n on frames from `persistence_first_frame` on. A process
/// that starts in the middle of a run reproduces the bytes by exposing those first.
///
/// Frames 1, 1 + w, 1 + 2 w ... begin a window of w frames. `trapped_e` counts charge trapped since
/// the beginning of the previous window, `younger_e` since that of the current one; at the next
/// beginning the second replaces the first. The charge dropped is below `persistence_forgotten` of
/// the charge once trapped.
struct PersistenceMemory {
  std::uint32_t next_frame = 0;  // the next exposure; 0: any, the traps are empty
  std::vector<float> trapped_e;  // rows x columns
  std::vector<float> younger_e;  // as many, or none yet
};

inline constexpr double persistence_forgotten = 1e-4;

/// Charge released during an exposure, `idle_s` after the previous one: trapped exp(-idle / tau) (1
/// - exp(-exposure / tau)).
struct Release {
  float kept_idle, kept_exposed;  // exp(-idle / tau), exp(-exposure / tau)

  Release(double tau_s, double idle_s, double exposure_s);
  void apply(std::span<float> trapped_e, std::span<float> released_e) const;
  /// Removes the released charge.
  void apply(std::span<float> trapped_e) const;
};

/// A fraction of the collected charge is trapped, is missing from its exposure and is released in
/// later ones: a Poisson deviate of the released charge is added.
struct Persistence {
  static constexpr EffectFacts facts{"persistence",
                                     "charge trapped in one exposure appears in the next ones",
                                     "no ghosts: 1e-3 to 1e-2 of what was collected",
                                     "Smith et al. 2008, Proc. SPIE 7021, 70210J"};
  double persistence_fraction = 0.0;  // share of the charge that is trapped, 0..1
  double persistence_s = 0.0;         // time constant with which it is freed
  bool operator==(const Persistence&) const = default;

  static std::span<const ParameterOf<Persistence>> parameters();
  static std::optional<DetectorFault> fault(const Detector& detector);
  void switch_off() { persistence_fraction = 0.0; }
  bool applies(const Detector&) const { return persistence_fraction > 0.0; }
  using Prepared = Release;
  Prepared prepare(const ExposureFacts& exposed) const;
  void apply(const ExposureFacts& exposed, const Prepared& release, Piece& piece) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);
};

/// Number of frames of a window at a cadence > 0 [s]: after it `persistence_forgotten` is left.
std::uint32_t persistence_window(double persistence_s, double cadence_s);
/// The first frame that frame `frame` depends on; itself without persistence.
std::uint32_t persistence_first_frame(const Persistence& persistence, double cadence_s,
                                      std::uint32_t frame);

/// Sets `caught_e` to the charge that goes into the traps: `fraction` of the collected charge, up
/// to the full well.
void caught(double fraction, double full_well_e, std::span<const float> collected_e,
            std::span<float> caught_e);

}  // namespace dmise
