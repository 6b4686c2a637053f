#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/detector/detector_effect.h"

namespace dmise {

/// Charge in a detector's traps between two exposures. A frame depends on its predecessors by this
/// alone, and on no more than 2 windows of them: frame n on those from `persistence_first_frame`
/// on. So whoever starts in the middle of a run gets the same bytes by exposing those first.
///
/// Frames 1, 1 + w, 1 + 2 w ... begin a window of w frames. `trapped_e` counts what was trapped
/// from the beginning of the window before, `younger_e` from that of this one; at the next
/// beginning it takes the other's place. What is forgotten so is below `persistence_forgotten` of
/// the charge once trapped.
struct PersistenceMemory {
  std::uint32_t next_frame = 0;  // the exposure that it waits for; 0: any, for the traps are empty
  std::vector<float> trapped_e;  // rows x columns
  std::vector<float> younger_e;  // as many, or none yet
};

inline constexpr double persistence_forgotten = 1e-4;

/// Charge that leaves the traps during an exposure, after they had `idle_s` since the one before:
/// trapped exp(-idle / tau) (1 - exp(-exposure / tau)), which is no longer trapped then.
struct Release {
  float kept_idle, kept_exposed;  // exp(-idle / tau), exp(-exposure / tau)

  Release(double tau_s, double idle_s, double exposure_s);
  void apply(std::span<float> trapped_e, std::span<float> released_e) const;
  /// The same without the released charge.
  void apply(std::span<float> trapped_e) const;
};

/// A share of the charge that an exposure collects is trapped and freed in the next ones: a Poisson
/// deviate of what the traps release is added.
struct Persistence {
  static constexpr EffectFacts facts{"persistence",
                                     "charge trapped in one exposure appears in the next ones",
                                     "no ghosts: 1e-3 to 1e-2 of what was collected",
                                     "Smith et al. 2008, Proc. SPIE 7021, 70210J"};
  double persistence_fraction = 0.0;  // of the charge collected is trapped, 0..1 ...
  double persistence_s = 0.0;         // ... and freed with this time constant
  bool operator==(const Persistence&) const = default;

  static std::span<const DetectorParameter> parameters();
  static std::optional<DetectorFault> fault(const Detector& detector);
  void switch_off() { persistence_fraction = 0.0; }
  bool applies(const Detector&) const { return persistence_fraction > 0.0; }
  using Prepared = Release;
  Prepared prepare(const ExposureFacts& exposed) const;
  void apply(const ExposureFacts& exposed, const Prepared& release, Piece& piece) const;
};

/// Frames of a window, at a cadence > 0: after so many of them `persistence_forgotten` is left.
std::uint32_t persistence_window(double persistence_s, double cadence_s);
/// The first frame that frame `frame` depends on, itself if there is no persistence.
std::uint32_t persistence_first_frame(const Persistence& persistence, double cadence_s,
                                      std::uint32_t frame);

/// Makes the memory of `pixels` pixels ready for exposure `frame`. Throws `Error` when it waits for
/// another.
void begin_frame(PersistenceMemory& memory, std::uint32_t frame, std::uint32_t window,
                 std::size_t pixels);

/// Traps `fraction` of what was collected, up to the full well.
void trap(double fraction, double full_well_e, std::span<const float> collected_e,
          std::span<float> trapped_e);

}  // namespace dmise
