#include "sensors/scene/state_window.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/config/objects/object_names.h"
#include "core/frames/rotation_angle.h"
#include "core/orbit/interpolation.h"
#include "core/orbit/motion.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/propagation/run_on.h"

namespace dmise {

Motion cubic_motion(double u, double tick_s, const Motion& before, const Motion& after) {
  const auto& [p0, s0] = before;
  const auto& [p1, s1] = after;
  return {interpolate_cubic(u, tick_s, p0, s0, p1, s1), (p1 - p0) * (6 * u * (1 - u) / tick_s) +
                                                            s0 * ((1 - u) * (1 - 3 * u)) +
                                                            s1 * (u * (3 * u - 2))};
}

void StateWindow::add(const std::shared_ptr<const State>& state) {
  const auto add_if_known = [&]<class One>(const One& one) {
    if constexpr (requires { this->add(std::shared_ptr<const One>(state, &one)); })
      this->add(std::shared_ptr<const One>(state, &one));
  };
  std::visit(add_if_known, *state);
}

void StateWindow::forget_before(SimTime t) {
  // Ticks before the last at or before `t`: a time on a tick belongs to the interval that ends
  // there.
  const bool cubic = order_ == HermiteOrder::cubic;
  const std::size_t beyond = cubic ? 0 : static_cast<std::size_t>(knots(order_)) - 1;
  while (states_.size() > beyond + 1 && states_[beyond + 1]->time <= t) states_.pop_front();
  while (environment_.size() > 1 && environment_[1]->time <= t) environment_.pop_front();
  while (sites_.size() > 1 && sites_[1]->time <= t && sites_[1]->sensor == sites_[0]->sensor)
    sites_.pop_front();
}

StateWindow::Around StateWindow::around(SimTime t) const {
  for (std::size_t k = 1; k < states_.size(); ++k)
    if (t <= states_[k]->time && t >= states_[k - 1]->time)
      return {states_[k - 1].get(), states_[k].get(), k - 1};
  if (!states_.empty() && states_.back()->time == t)
    return {states_.back().get(), states_.back().get(), states_.size() - 1};
  throw Error("no object states at " + std::to_string(t.seconds()) + " s");
}

KnotTicks StateWindow::ticks_for(SimTime start, SimTime end) const {
  const auto ticks_at = [&](SimTime t) {
    const Around interval = around(t);
    const KnotTicks two{interval.before->tick, interval.after->tick};
    if (order_ == HermiteOrder::cubic || interval.before == interval.after) return two;
    return knot_ticks(order_, interval.before->tick, last_tick_);
  };
  return {ticks_at(start).first, ticks_at(end).last};
}

void StateWindow::set_states(std::vector<std::uint32_t> objects, std::vector<ObjectStates> states) {
  for (auto& of_tick : states)
    for (auto& held : states_)
      if (held->tick == of_tick.tick) {
        held = std::make_shared<const ObjectStates>(std::move(of_tick));
        break;
      }
  known_ = std::move(objects);
}

std::optional<std::size_t> StateWindow::place(std::size_t i) const {
  if (!known_) return i;
  const auto found = std::lower_bound(known_->begin(), known_->end(), i);
  if (found == known_->end() || *found != i) return std::nullopt;
  return std::size_t(found - known_->begin());
}

bool StateWindow::has_state(std::size_t i, SimTime t) const {
  const auto [before, after, index] = around(t);
  const auto k = place(i);
  return k && before->code[*k] == 0 && after->code[*k] == 0;
}

std::string StateWindow::why_no_state(std::size_t i, SimTime t) const {
  const auto [before, after, index] = around(t);
  const auto k = place(i);
  if (!k) return "its states are not known";
  const ObjectStates& without = before->code[*k] != 0 ? *before : *after;
  const std::uint8_t code = without.code[*k];
  const bool of_elements = code < std::uint8_t(MotionCode::outside_span);
  const std::string_view why = of_elements ? describe(Sgp4Code(code)) : describe(MotionCode(code));
  return std::string(why) + ", at tick " + std::to_string(without.tick);
}

const ObjectStates& StateWindow::at_tick(const Around& interval, Tick tick) const {
  const Tick index = static_cast<Tick>(interval.index) + tick - interval.before->tick;
  if (index < 0 || index >= static_cast<Tick>(states_.size()) ||
      states_[static_cast<std::size_t>(index)]->tick != tick)
    throw Error("no object states of tick " + std::to_string(tick));
  return *states_[static_cast<std::size_t>(index)];
}

bool StateWindow::has_states(std::size_t place, const Around& interval,
                             const KnotTicks& knots) const {
  for (Tick tick = knots.first; tick <= knots.last; ++tick)
    if (at_tick(interval, tick).code[place] != 0) return false;
  return true;
}

Motion StateWindow::of_higher_order(std::size_t place, const Around& interval,
                                    const KnotTicks& knots, double u) const {
  const double tick_s = (interval.after->time - interval.before->time).seconds();
  const HermiteWeights w =
      hermite_weights(static_cast<int>(knots.first - interval.before->tick),
                      static_cast<int>(knots.last - knots.first) + 1, u, tick_s);
  Motion motion;
  for (std::size_t k = 0; k < static_cast<std::size_t>(w.count); ++k) {
    const ObjectStates& knot = at_tick(interval, knots.first + static_cast<Tick>(k));
    const Vec<Gcrs> position_m = knot.position(place), slope_m_per_s = knot.slope(place);
    motion.position_m += position_m * w.position[k] + slope_m_per_s * w.slope_s[k];
    motion.slope_m_per_s += position_m * w.position_per_s[k] + slope_m_per_s * w.slope[k];
  }
  return motion;
}

Motion StateWindow::motion(std::size_t object, SimTime t) const {
  const Around interval = around(t);
  const auto known = place(object);
  if (!known) throw Error("no states of object " + std::to_string(object));
  const std::size_t i = *known;
  const auto [before, after, index] = interval;
  if (before == after) return {before->position(i), before->slope(i)};
  const double tick_s = (after->time - before->time).seconds();
  const double u = (t - before->time).seconds() / tick_s;
  if (order_ != HermiteOrder::cubic) {
    const KnotTicks knots = knot_ticks(order_, before->tick, last_tick_);
    if (has_states(i, interval, knots)) return of_higher_order(i, interval, knots, u);
  }
  return cubic_motion(u, tick_s, {before->position(i), before->slope(i)},
                      {after->position(i), after->slope(i)});
}

std::optional<Rotation<Gcrs, Body>> StateWindow::gcrs_from_body(std::size_t i, SimTime t) const {
  const auto [before, after, index] = around(t);
  const auto k = place(i);
  if (!k) return std::nullopt;
  const auto start = before->attitude(*k), end = after->attitude(*k);
  if (!start || !end) return std::nullopt;
  if (before == after) return rotation_of<Gcrs, Body>(start->gcrs_from_body);
  const double tick_s = (after->time - before->time).seconds();
  return rotation_of<Gcrs, Body>(
      interpolate_attitude((t - before->time).seconds() / tick_s, tick_s, *start, *end));
}

std::optional<double> StateWindow::albedo(std::size_t i, SimTime t) const {
  const auto [before, after, index] = around(t);
  const auto k = place(i);
  if (!k) return std::nullopt;
  const auto start = before->albedo_of(*k), end = after->albedo_of(*k);
  if (!start || !end) return std::nullopt;
  if (before == after) return start;
  const double tick_s = (after->time - before->time).seconds();
  return std::lerp(*start, *end, (t - before->time).seconds() / tick_s);
}

namespace {

/// Angular speed of the interpolated attitude, by a difference over less than 0.1 rad.
double rate_rad_per_s(double u, double tick_s, const AttitudeState& start,
                      const AttitudeState& end) {
  const double max_rad =  // bound on the turn within one tick
      20.0 + tick_s * (3.0 * norm(start.rate_rad_per_s) + norm(end.rate_rad_per_s));
  const double du = 0.05 / max_rad;
  const auto at = [&](double part) {
    return rotation_of<Gcrs, Body>(interpolate_attitude(part, tick_s, start, end));
  };
  return rotation_angle_rad(at(u + du) * at(u - du).inverse()) / (2.0 * du * tick_s);
}

}  // namespace

double StateWindow::turn_rad(std::size_t i, SimTime start, SimTime end) const {
  constexpr int steps = 8;  // parts of one tick, within which the rate is smooth
  const auto k = place(i);
  double turn = 0.0;
  for (std::size_t tick = 1; k && tick < states_.size(); ++tick) {
    const ObjectStates &before = *states_[tick - 1], &after = *states_[tick];
    if (before.time >= end) break;
    const SimTime from = std::max(start, before.time), to = std::min(end, after.time);
    if (!(from < to)) continue;
    const auto a = before.attitude(*k), b = after.attitude(*k);
    if (!a || !b) continue;
    const double tick_s = (after.time - before.time).seconds();
    const double step_s = (to - from).seconds() / steps;
    for (int step = 0; step < steps; ++step) {
      const double t_s = (from - before.time).seconds() + (step + 0.5) * step_s;
      turn += step_s * rate_rad_per_s(t_s / tick_s, tick_s, *a, *b);
    }
  }
  return turn;
}

EnvironmentState StateWindow::environment(SimTime t) const {
  for (auto state = environment_.rbegin(); state != environment_.rend(); ++state)
    if ((*state)->time <= t) return run_on(**state, t);
  throw Error("no environment at " + std::to_string(t.seconds()) + " s");
}

const EnvironmentState* StateWindow::environment_of(SimTime t) const {
  for (const auto& state : environment_)
    if (state->time == t) return state.get();
  return nullptr;
}

const SiteState* StateWindow::site(const std::string& sensor, SimTime t) const {
  for (auto state = sites_.rbegin(); state != sites_.rend(); ++state)
    if ((*state)->sensor == sensor && (*state)->time <= t) return state->get();
  return nullptr;
}

std::size_t object_index(const ObjectRoster& roster, const std::string& name,
                         const std::string& what) {
  std::size_t found = roster.objects.size();
  std::uint32_t number = 0;
  std::from_chars(name.data(), name.data() + name.size(), number);
  const bool is_number = std::to_string(number) == name;
  for (std::size_t i = 0; i < roster.objects.size(); ++i) {
    const auto& object = roster.objects[i];
    if (is_number && object.catalogue_number == number) return i;
    if (object.name != name) continue;
    if (found < roster.objects.size())
      throw ConfigError(what + ": several objects have this name, give the catalogue number, got " +
                        printable(name));
    found = i;
  }
  if (found < roster.objects.size()) return found;
  std::vector<std::string> names;
  for (const auto& object : roster.objects) names.push_back(object.name);
  const std::string hint = nearest_object(name, names);
  throw ConfigError(what + ": no such object" +
                    (hint.empty() ? "" : ", did you mean " + printable(hint) + "?") + ", got " +
                    printable(name));
}

}  // namespace dmise
