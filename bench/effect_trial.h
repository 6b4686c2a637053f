#pragma once
#include <string>
#include <vector>

#include "bench/effect_scene.h"
#include "sensors/accuracy/frame_error.h"

namespace dmise {

/// One effect at one level below its reference, alone, in one scene.
struct LevelTrial {
  int scene = 0;
  std::string effect, level;
  ErrorBound bound, measured;
  ErrorBound budget;            // in which a plan took it; zero: none did
  bool has_sources = false;     // there are such as it concerns, whose errors count
  bool has_background = false;  // there are pixels between sources

  /// Whether the bound of `kind` holds, but for the precision of what is measured.
  bool holds(const ErrorKind& kind) const;
};

/// A planned frame of one scene.
struct PlanTrial {
  int scene = 0;
  std::string accuracy;
  ErrorBound budget, bound, measured;

  bool within(const ErrorKind& kind) const;
};

/// What was measured in one scene.
struct SceneTrial {
  EffectScene scene;
  std::size_t sources = 0, background_pixels = 0;
  std::vector<PlanTrial> plans;
  std::vector<LevelTrial> levels;
  double plan_s = 0.0;  // median time of a plan

  bool within_budgets() const;
  bool bounds_hold() const;
};

struct TrialOptions {
  std::uint64_t seed = 1;
  bool every_level = false;  // also those that no plan took
  std::string effect;        // every level of this one alone, and no budget; empty: all
};

/// Draws scene `number`, makes its reference, its planned frames and the reference with one effect
/// at a time at the levels of the plans.
SceneTrial try_scene(int number, const TrialOptions& options,
                     const std::filesystem::path& directory, Threads& threads);

}  // namespace dmise
