#pragma once
#include <deque>
#include <limits>
#include <memory>
#include <optional>

#include "core/orbit/interpolation.h"
#include "core/products/task.h"
#include "core/sim/message.h"
#include "core/sim/state.h"

namespace dmise {

/// Position and its derivative in GCRS.
struct Motion {
  Vec<Gcrs> position_m;
  Vec<Gcrs> slope_m_per_s;
};

/// The cubic between two ticks at the fraction `u` of the `tick_s` between them, and its
/// derivative, so that a velocity agrees with its path.
Motion cubic_motion(double u, double tick_s, const Motion& before, const Motion& after);

/// The published states around an exposure: the last few ticks of what actors said, interpolated.
class StateWindow {
 public:
  StateWindow() = default;
  /// `last_tick`: of the run, where higher orders find no ticks beyond.
  StateWindow(HermiteOrder order, Tick last_tick) : order_(order), last_tick_(last_tick) {}

  void add(std::shared_ptr<const ObjectRoster> roster) { roster_ = std::move(roster); }
  void add(std::shared_ptr<const ObjectStates> states) { states_.push_back(std::move(states)); }
  /// Adds a tick whose states are not known: `set_states` gives those that an exposure needs.
  void add_tick(Tick tick, SimTime time) {
    add(std::make_shared<const ObjectStates>(ObjectStates{.tick = tick, .time = time}));
  }
  void add(std::shared_ptr<const EnvironmentState> state) {
    environment_.push_back(std::move(state));
  }
  void add(std::shared_ptr<const SiteState> state) { sites_.push_back(std::move(state)); }
  /// Adds a state that is one of these; others change nothing.
  void add(const std::shared_ptr<const State>& state);
  /// The task that a sensor that is cued does from now on; null: none, it is parked.
  void follow(std::shared_ptr<const Task> task) { task_ = std::move(task); }
  const Task* task() const { return task_.get(); }
  /// Forgets what is not needed for times >= `t`.
  void forget_before(SimTime t);

  /// The first tick whose states it has; 0 if it has none.
  Tick first_tick() const { return states_.empty() ? 0 : states_.front()->tick; }
  /// Ticks that the states in [start, end] are interpolated from.
  KnotTicks ticks_for(SimTime start, SimTime end) const;
  /// Restricts the window to `objects`, ascending indices, with their states at `ticks_for` an
  /// exposure: `states` has those of one tick, object k of which is `objects[k]`.
  void set_states(std::vector<std::uint32_t> objects, std::vector<ObjectStates> states);

  const ObjectRoster& roster() const { return *roster_; }
  std::size_t object_count() const { return roster_ ? roster_->objects.size() : 0; }
  /// Indices of the objects whose states are known, if not all.
  const std::optional<std::vector<std::uint32_t>>& restricted_to() const { return known_; }

  /// Whether object `i` has a state at both ticks around `t`.
  bool has_state(std::size_t i, SimTime t) const;
  /// Why it has none, for a message: "its path enters the Earth, at tick 3".
  std::string why_no_state(std::size_t i, SimTime t) const;
  /// Hermite interpolation of the run's order on position and slope; cubic where the object has no
  /// state at one of the ticks beyond those around `t`. `t` must lie within the ticks held, with
  /// those of `knot_ticks`, and the object have a state there.
  Motion motion(std::size_t i, SimTime t) const;
  /// Attitude between the ticks around `t`; nothing for an object without one. `t` as for `motion`.
  std::optional<Rotation<Gcrs, Body>> gcrs_from_body(std::size_t i, SimTime t) const;

  /// Albedo of the object between the ticks around `t`, linear; nothing if that is the roster's.
  /// `t` as for `motion`.
  std::optional<double> albedo(std::size_t i, SimTime t) const;

  /// Angle that the object turns by from `start` to `end` [rad], whole turns too; 0 for an object
  /// without an attitude. Times as for `motion`.
  double turn_rad(std::size_t i, SimTime start, SimTime end) const;

  /// The environment at `t`: that last published at or before it, run on by its rates (`run_on`).
  EnvironmentState environment(SimTime t) const;
  /// That published for `t` itself; null if there is none.
  const EnvironmentState* environment_of(SimTime t) const;
  /// The air over a ground sensor as last published at or before `t`; null if it never was.
  const SiteState* site(const std::string& sensor, SimTime t) const;

 private:
  struct Around {
    const ObjectStates* before;
    const ObjectStates* after;
    std::size_t index = 0;  // place of `before` in `states_`
  };
  Around around(SimTime t) const;
  /// Place of object `i` in the states; nothing if its states are not known.
  std::optional<std::size_t> place(std::size_t i) const;
  Motion of_higher_order(std::size_t place, const Around& interval, const KnotTicks& knots,
                         double u) const;
  bool has_states(std::size_t place, const Around& interval, const KnotTicks& knots) const;
  const ObjectStates& at_tick(const Around& interval, Tick tick) const;

  HermiteOrder order_ = HermiteOrder::cubic;
  Tick last_tick_ = std::numeric_limits<Tick>::max() / 2;
  std::shared_ptr<const ObjectRoster> roster_;
  std::deque<std::shared_ptr<const ObjectStates>> states_;
  std::optional<std::vector<std::uint32_t>> known_;  // ascending; none: all
  std::deque<std::shared_ptr<const EnvironmentState>> environment_;
  std::deque<std::shared_ptr<const SiteState>> sites_;
  std::shared_ptr<const Task> task_;
};

/// Index of the object with this catalogue number or name. Throws `ConfigError` with `what` first
/// if there is none or the name belongs to several.
std::size_t object_index(const ObjectRoster& roster, const std::string& name,
                         const std::string& what);

}  // namespace dmise
