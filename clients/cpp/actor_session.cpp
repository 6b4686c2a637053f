#include "clients/cpp/actor_session.h"

#include <utility>
#include <variant>

#include "clients/cpp/said_states.h"
#include "core/base/error.h"
#include "nodes/wire/envelope.h"
#include "nodes/wire/state_codec.h"

namespace dmise {
namespace {

ActorTask task_of(const v1::OwnNodeBegin& begin) {
  ActorTask task{.node = begin.node(),
                 .objects = {},
                 .options = nlohmann::json::parse(begin.options_json(), nullptr, false),
                 .start_utc = begin.start_utc(),
                 .seed = begin.seed(),
                 .tick = {begin.tick_ns()},
                 .last_tick = begin.last_tick(),
                 .period_ticks = begin.period_ticks()};
  for (const v1::OwnNodeObject& object : begin.objects()) task.objects.push_back(object.name());
  return task;
}

void check(const v1::OwnNodeBegin& begin, const ActorTask& task) {
  if (begin.schema_version() != wire_schema_version)
    throw Error("the run has schema version " + std::to_string(begin.schema_version()) +
                ", this program " + std::to_string(wire_schema_version));
  if (begin.has_sensor())
    throw Error("the program moves objects, the scenario has it detect in the frames of " +
                begin.sensor());
  if (begin.has_tracking())
    throw Error("the program moves objects, the scenario has it make the tracks");
  if (begin.has_observing())
    throw Error("the program moves objects, the scenario has it observe as " +
                begin.observing().sensor().name());
  if (!task.options.is_object()) throw Error("begin: options_json: must be one JSON object");
  if (task.tick.ns <= 0) throw Error("begin: tick_ns: must be > 0");
  if (task.last_tick < 0) throw Error("begin: last_tick: must be >= 0");
  if (task.period_ticks < 1) throw Error("begin: period_ticks: must be >= 1");
  const double every_s = begin.alive_every_s();
  if (!(every_s > 0 && every_s <= 1e6)) throw Error("begin: alive_every_s: must be in (0, 1e6]");
}

v1::OwnNodeRequest request_in(std::string_view frame) {
  v1::OwnNodeRequest request;
  if (!request.ParseFromArray(frame.data(), int(frame.size())) ||
      request.body_case() == v1::OwnNodeRequest::BODY_NOT_SET)
    throw Error("what the run says is no request (" + std::to_string(frame.size()) + " bytes)");
  return request;
}

std::vector<Message> heard_in(const v1::OwnNodeStep& step) {
  std::vector<Message> messages;
  for (const v1::OwnNodeHeard& one : step.heard())
    messages.push_back(
        {one.topic(), one.tick(),
         std::make_shared<State>(decode(MessageKind(one.kind()), one.payload(), one.arrays()))});
  return messages;
}

}  // namespace

std::optional<std::vector<std::string>> ActorSession::answer(
    std::span<const std::string_view> frames) {
  const v1::OwnNodeRequest request = request_in(frames[0]);
  if (request.has_end()) return std::nullopt;
  if (request.has_begin()) return begin(request.begin());
  if (!request.has_step()) throw Error("the run asks for what is no state of objects");
  if (!model_) throw Error("the run asks for a step before it begins");
  if (frames.size() != 2)
    throw Error("a step: must have 2 frames, got " + std::to_string(frames.size()));
  return step(request.step(), frames[1]);
}

std::vector<std::string> ActorSession::begin(const v1::OwnNodeBegin& begin) {
  if (model_) throw Error("the run begins twice");
  task_ = task_of(begin);
  check(begin, task_);
  begun_ = begin;
  begins_(begin.alive_every_s());
  model_ = make_(task_);
  if (begin.has_checkpoint()) model_->restore(begin.checkpoint());
  v1::OwnNodeAnswer answer;
  answer.mutable_ready();
  return {answer.SerializeAsString()};
}

std::vector<std::string> ActorSession::step(const v1::OwnNodeStep& step,
                                            std::string_view environment) {
  ActorWorld world{.task = task_,
                   .tick = step.tick(),
                   .time = {step.time_ns()},
                   .environment = {},
                   .heard = heard_in(step)};
  world.environment =
      std::get<EnvironmentState>(decode(MessageKind::environment_state, environment, {}));
  if (world.environment.tick != world.tick)
    throw Error("a step: must have the environment of its tick, got that of tick " +
                std::to_string(world.environment.tick));
  Encoded states = encode(said_states(model_->step(world), begun_, world.tick, world.time));
  v1::OwnNodeAnswer answer;
  v1::OwnNodeStepped& stepped = *answer.mutable_stepped();
  if (step.give_checkpoint())
    if (auto checkpoint = model_->checkpoint()) stepped.set_checkpoint(std::move(*checkpoint));
  return {answer.SerializeAsString(), std::move(states.payload), std::move(states.arrays)};
}

}  // namespace dmise
