#pragma once
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/config/scenario.h"
#include "core/forces/forces.h"
#include "core/fusion/live_track.h"
#include "core/propagation/environment_source.h"
#include "core/time/clock.h"
#include "nodes/fusion/tracker.h"
#include "nodes/own/own_node_run.h"

namespace dmise {

/// Makes tracks by a program of the user's, which is started at the first tick. Under
/// `on_silent_node: restart` a program that dies or is silent is started again, hears the ticks
/// since its last checkpoint, and must say the same.
class OwnTracker : public Tracker {
 public:
  using Again = std::function<void(Tick, std::span<const SearchedFrame>)>;
  /// Calls the function for each tick from the first to the one before the second.
  using Replay = std::function<void(Tick, Tick, const Again&)>;

  /// `scenario` must outlive it, and have `fusion.node`. `known`: objects with elements that the
  /// program may know beforehand.
  OwnTracker(const Scenario& scenario, const ObjectRoster& known, const Clock& clock,
             OwnNodeSettings settings, Replay replay);

  std::optional<Tracked> step(Tick tick, std::span<const SearchedFrame> frames) override;
  std::vector<CueTarget> targets(SimTime time) const override;

 private:
  struct Live {
    Track track;  // as it was last
    MeanBrightness brightness;
  };
  struct Source {
    const Detection* detection;
    bool taken = false;
  };
  using Sources = std::map<std::string, Source, std::less<>>;
  using Told = std::optional<OwnModel::Tracked>;

  void start();
  Told ask(Tick tick, std::span<const SearchedFrame> frames);
  Told ask_up_to(Tick tick, std::span<const SearchedFrame> frames);
  Tracked take(TrackSet&& set, std::span<const SearchedFrame> frames);
  void take(Track& track, Sources& sources);
  void check(const Track& track, const Live* before) const;
  void count(Track& track, Live& live, Sources& sources) const;
  std::vector<CueWish> wishes_of(const v1::OwnNodePoints& points) const;

  const Scenario& scenario_;
  EnvironmentByMinutes environment_;
  OwnNode node_;
  OwnNodeSettings settings_;
  Replay replay_;
  ForceModel forces_;
  std::string roster_, roster_arrays_;          // as the program hears them
  std::map<std::uint32_t, std::string> names_;  // by catalogue number
  std::set<std::string, std::less<>> cued_;     // sensors
  std::map<std::uint32_t, Live> live_;          // by id
  std::set<std::uint32_t> ended_;               // ids
  std::unique_ptr<OwnModel> program_;
  OwnRecord said_;
  OwnRestarts restarts_;
};

}  // namespace dmise
