#include "nodes/own/own_actor.h"

#include <algorithm>

#include "core/base/formatted.h"
#include "core/config/own_node_roles.h"
#include "core/frames/oblate_earth.h"
#include "core/orbit/interpolation_error.h"
#include "nodes/own/joined_states.h"
#include "nodes/wire/state_codec.h"

namespace dmise {
namespace {

constexpr Tick max_ahead = 64;                 // calls
constexpr std::size_t states_ahead = 100'000;  // states of objects: 7 MB
constexpr std::size_t calls_held = 3;          // for joining two, and for the error between three
constexpr double tolerated_error_m = 1.0;  // between ticks, or what the run's order is stated for

/// Number of calls that the program may be asked for before it has answered. A run that keeps time
/// asks for each when it is due, and so does a node that hears what others say.
Tick calls_ahead(const Scenario& scenario, const OwnNode& node, std::size_t objects) {
  if (scenario.network.real_time > 0.0 || !node.consumes.empty()) return 0;
  return std::clamp<Tick>(Tick(states_ahead / std::max<std::size_t>(objects, 1)), 1, max_ahead);
}

std::string list_text(std::span<const std::uint32_t> numbers) {
  std::string text;
  for (const std::uint32_t number : numbers.first(std::min<std::size_t>(numbers.size(), 8)))
    text += (text.empty() ? "" : " ") + std::to_string(number);
  return text.empty() ? "none" : numbers.size() > 8 ? text + " .." : text;
}

}  // namespace

OwnActor::OwnActor(const Scenario& scenario, const OwnNode& node, Clock clock,
                   OwnNodeSettings settings)
    : scenario_(scenario),
      node_(node),
      environment_(std::move(clock)),
      settings_(std::move(settings)),
      restarts_(scenario.network, node.name, settings_) {
  for (const OwnObject& object : scenario.own_objects) {
    const bool turned = is_turned_by(node, object);
    if (!turned && !is_moved_by(node, object)) continue;
    if (turned) turned_.push_back(std::uint32_t(objects_.size()));
    objects_.push_back(&object);
  }
  if (!node_.consumes.empty()) journal_.emplace(settings_.journal_path);
  warned_.resize(objects_.size());
  underground_.resize(objects_.size());
}

std::vector<std::string> OwnActor::produces() const { return {actor_prefix + node_.name}; }

std::vector<Message> OwnActor::resume(Tick, std::span<const Message>) {
  if (journal_) kept_ = journal_->resume();
  return {};
}

/// Keeps what the program hears at a tick, but for what the journal has already.
void OwnActor::keep(Tick tick, std::span<const Message> inputs) {
  if (tick == 0 && kept_ == 0) journal_->clear();
  if (tick < kept_) return;
  std::vector<Message> heard;
  for (const Message& message : inputs)
    if (message.tick == tick - node_.delay_ticks) heard.push_back(message);
  journal_->add(heard);
  journal_->end(tick);
  kept_ = tick + 1;
}

std::vector<Message> OwnActor::step(Tick tick, std::span<const Message> inputs) {
  if (journal_) keep(tick, inputs);
  const Tick call = tick / node_.period_ticks;
  const bool between = tick % node_.period_ticks != 0;
  if (!hear_up_to(between ? call + 1 : call)) return {};
  ObjectStates states =
      between ? joined_states(states_of(call), states_of(call + 1), tick, scenario_.time_of(tick))
              : states_of(call);
  ++steps_;
  if (tick == scenario_.last_tick()) program_.reset();
  return {{actor_prefix + node_.name, tick, std::make_shared<State>(std::move(states))}};
}

const ObjectStates& OwnActor::states_of(Tick call) const {
  return *std::ranges::find(held_, tick_of(call), &ObjectStates::tick);
}

std::string OwnActor::lost_at() const {
  const std::string first = "tick " + std::to_string(tick_of(said_.next()));
  return asked_.size() > 1 ? first + " to " + std::to_string(asked_.back().tick) : first;
}

bool OwnActor::hear_up_to(Tick call) {
  const auto is_held = [&] { return !held_.empty() && held_.back().tick >= tick_of(call); };
  while (!is_held()) {
    try {
      if (!hear()) return false;
    } catch (const ProgramLost& lost) {
      program_.reset();
      restarts_.after(lost, lost_at());
    } catch (const ProgramEnded& ended) {
      throw Error(settings_.error_prefix + lost_at() + ": " + ended.what());
    } catch (const Error& error) {
      throw Error(settings_.error_prefix + "tick " + std::to_string(tick_of(said_.next())) + ": " +
                  error.what());
    }
    ++steps_;
  }
  return true;
}

bool OwnActor::hear() {
  if (!program_) start();
  if (!ask()) return false;
  auto stepped = program_->stepped();
  if (!stepped) return false;
  check(stepped->states);
  look_at_places(stepped->states, asked_.front().earth);
  const Tick tick = tick_of(said_.next());
  said_.add(stepped->digest, std::move(stepped->checkpoint), "states");
  asked_.pop_front();
  if (!held_.empty() && held_.back().tick >= tick) return true;  // said before
  held_.push_back(std::move(stepped->states));
  if (held_.size() > calls_held) held_.pop_front();
  look_at_errors();
  return true;
}

bool OwnActor::ask() {
  if (asked_.empty()) {
    asked_.push_back(environment_of(said_.next()));
    v1::OwnNodeStep step = step_of(said_.next());
    if (heard_) add_heard(step);
    if (!program_->ask(step, asked_.back())) return false;
  }
  const Tick ahead = calls_ahead(scenario_, node_, objects_.size());
  if (Tick(asked_.size()) > ahead / 2) return true;  // the next ones go together
  const Tick last = (scenario_.last_tick() + node_.period_ticks - 1) / node_.period_ticks;
  for (Tick call = said_.next() + Tick(asked_.size()); call <= std::min(said_.next() + ahead, last);
       ++call) {
    EnvironmentState environment = environment_of(call);
    if (!program_->ask_ahead(step_of(call), environment)) break;
    asked_.push_back(std::move(environment));
  }
  return true;
}

v1::OwnNodeStep OwnActor::step_of(Tick call) const {
  v1::OwnNodeStep step;
  step.set_tick(tick_of(call));
  step.set_time_ns(scenario_.time_of(tick_of(call)).ns);
  step.set_give_checkpoint(OwnRecord::wants_checkpoint(call));
  return step;
}

void OwnActor::add_heard(v1::OwnNodeStep& step) {
  std::vector<Message> messages;
  if (!heard_->next(&messages))
    throw Error(journal_->path() + ": ends before tick " + std::to_string(step.tick()));
  for (const Message& message : messages) {
    Encoded encoded = encode(*message.state);
    v1::OwnNodeHeard& one = *step.add_heard();
    one.set_topic(message.topic);
    one.set_kind(v1::Kind(encoded.kind));
    one.set_tick(message.tick);
    one.set_payload(std::move(encoded.payload));
    one.set_arrays(std::move(encoded.arrays));
  }
}

EnvironmentState OwnActor::environment_of(Tick call) {
  return environment_.at(tick_of(call), scenario_.time_of(tick_of(call)));
}

v1::OwnNodeBegin OwnActor::begin() const {
  v1::OwnNodeBegin begin = begin_of(scenario_, node_);
  for (const OwnObject* object : objects_) {
    v1::OwnNodeObject& one = *begin.add_objects();
    one.set_name(object->name);
    one.set_catalogue_number(object->catalogue_number);
    one.set_moved(is_moved_by(node_, *object));
    one.set_turned(is_turned_by(node_, *object));
  }
  return begin;
}

void OwnActor::start() {
  asked_.clear();
  v1::OwnNodeBegin told = begin();
  said_.continue_at(told);
  if (journal_) {
    heard_.emplace(journal_->path());
    while (heard_->tick() < said_.next() && heard_->next(nullptr)) {
    }
  }
  program_ = settings_.start({scenario_, node_, settings_, told, restarts_.any()});
}

void OwnActor::check(const ObjectStates& states) const {
  const Tick tick = tick_of(said_.next());
  if (states.tick != tick || states.time != scenario_.time_of(tick))
    throw Error("its states are of tick " + std::to_string(states.tick) + ", " +
                formatted("%.9g", states.time.seconds()) + " s");
  if (states.count != objects_.size())
    throw Error("count: must be " + std::to_string(objects_.size()) +
                ", one for each object, got " + std::to_string(states.count));
  for (const std::uint8_t code : states.code)
    if (code != 0 && code != std::uint8_t(MotionCode::untold))
      throw Error("code: must be 0 or " + std::to_string(int(MotionCode::untold)) +
                  " (no state), got " + std::to_string(int(code)));
  for (std::size_t i = 0; i < objects_.size(); ++i)
    if (states.albedo_of(i) && (!is_moved_by(node_, *objects_[i]) || objects_[i]->geometry))
      throw Error("albedo: is of objects without a geometry that the node moves, " +
                  objects_[i]->name + " is none");
  if (states.attitude_object != turned_)
    throw Error("attitude_object: must be " + list_text(turned_) +
                ", the objects that it turns, got " + list_text(states.attitude_object));
}

/// Warns of objects that are not in the scene: that are under the ground, or all of them at tick 0.
void OwnActor::look_at_places(const ObjectStates& states, const EarthOrientation& earth) {
  if (states.tick == 0 && std::ranges::count(states.code, 0) == 0)
    settings_.note(node_.name +
                   ": no object has a state at tick 0: does the model return what it computes?");
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (underground_[i] || states.code[i] != 0 || !is_moved_by(node_, *objects_[i])) continue;
    if (is_above_ground(states.position(i), earth, scenario_.earth.ellipsoid)) continue;
    underground_[i] = true;
    settings_.note(
        node_.name + ": " + objects_[i]->name +
        formatted(
            " is not in the scene at tick %ld: %.6g m from the Earth's centre is under the ground; "
            "are its positions in m?",
            long(states.tick), norm(states.position(i))));
  }
}

/// Warns of objects whose paths between ticks are not what the planner takes them for.
void OwnActor::look_at_errors() {
  if (held_.size() < 3) return;
  const auto stated = stated_interpolation_error(
      HermiteOrder::cubic, scenario_.tick.seconds() * double(node_.period_ticks));
  const double max_m = std::max(tolerated_error_m, stated ? stated->worst_m : 0.0);
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (warned_[i] || !is_moved_by(node_, *objects_[i])) continue;
    const double error_m = cubic_error_m({&held_[0], &held_[1], &held_[2]}, i);
    if (!(error_m > max_m) || error_m > 1e300) continue;
    warned_[i] = true;
    settings_.note(
        node_.name + ": " + objects_[i]->name +
        formatted(" is off by about %.3g m between ticks, at tick %ld: do its velocities "
                  "fit its positions, and are ticks short enough?",
                  error_m, long(held_[1].tick)));
  }
}

}  // namespace dmise
