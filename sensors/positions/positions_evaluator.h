#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "core/config/node_kinds.h"
#include "core/sim/participant.h"
#include "core/time/clock.h"
#include "core/visibility/pointing.h"
#include "sensors/positions/position_files.h"

namespace dmise {

/// Writes at every tick the positions of cameras, their platforms and targets, the scenario's own
/// objects, Sun and Moon, in GCRS or in east, north and up. A camera's attitude is that of aiming
/// at that instant, also between exposures.
class PositionsEvaluator : public Evaluator {
 public:
  /// Throws `Error` if `directory` cannot be written.
  PositionsEvaluator(const Scenario& scenario, Clock clock, const std::string& directory);

  std::string name() const override { return positions_node; }
  std::vector<std::string> produces() const override { return {}; }
  std::vector<std::string> consumes() const override { return {objects_topic, environment_topic}; }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;
  /// The previous tick, which may be the first of an ephemeris, and the latest environment state.
  Tick look_back() const override;
  std::vector<Message> resume(Tick tick, std::span<const Message> past) override;
  std::uint64_t progress() const override { return steps_; }

 private:
  struct Mount {
    std::optional<std::size_t> platform, target;  // objects
  };
  void take_in(const Message& message);
  void take_roster(const ObjectRoster& roster);
  void write(Tick tick);
  std::vector<PositionRow> rows(Tick tick) const;
  std::optional<PositionRow> camera(std::size_t sensor, Tick tick) const;
  /// Adds what tables have in east, north and up.
  void turn_to_enu(std::vector<PositionRow>& rows, SimTime t) const;
  std::string utc(Tick tick) const;

  Scenario scenario_;
  Clock clock_;
  PositionFiles files_;
  std::shared_ptr<const ObjectRoster> roster_;
  std::shared_ptr<const ObjectStates> states_;
  std::shared_ptr<const EnvironmentState> environment_;
  std::vector<std::size_t> objects_;  // in the table, ascending
  std::vector<Mount> mounts_;         // by sensor
  bool begun_ = false;
  std::atomic<std::uint64_t> steps_{0};
};

}  // namespace dmise
