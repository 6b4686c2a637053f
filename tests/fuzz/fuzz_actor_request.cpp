// Hostile requests for a program in C++, in any order. Input: parts, each a request and the
// environment that is its second frame; an empty one is none.
#include <google/protobuf/stubs/logging.h>

#include "clients/cpp/actor_session.h"
#include "core/base/error.h"
#include "nodes/wire/state_codec.h"
#include "tests/fuzz/chunks.h"
#include "tests/wire/examples.h"

namespace {

using namespace dmise;

// Texts that are none are refused; the library would also print each.
[[maybe_unused]] const auto printing = google::protobuf::SetLogHandler(nullptr);

struct Still {
  explicit Still(const ActorTask& task) : count(task.objects.size()) {
    if (!task.options.is_object() || task.tick.ns <= 0 || task.period_ticks < 1) __builtin_trap();
    if (task.options.contains("radius_m")) radius_m = task.number("radius_m");
  }
  std::vector<ObjectState> step(const ActorWorld&) const {
    return std::vector<ObjectState>(count, {.position_m = {radius_m, 0, 0},
                                            .velocity_m_per_s = {},
                                            .attitude = AttitudeState{{1, 0, 0, 0}, {}}});
  }
  static std::string checkpoint() { return "still"; }
  static void restore(std::string_view checkpoint) {
    if (checkpoint != "still") throw Error("another model");
  }

  std::size_t count;
  double radius_m = 7e6;
};

void require_answers(const v1::OwnNodeRequest& request, const std::vector<std::string>& frames,
                     int objects) {
  v1::OwnNodeAnswer answer;
  if (!answer.ParseFromString(frames.at(0))) __builtin_trap();
  if (answer.has_ready() && request.has_begin()) return;
  if (!answer.has_stepped() || !request.has_step() || frames.size() != 3) __builtin_trap();
  const State state = decode(MessageKind::object_states, frames[1], frames[2]);
  const auto& states = std::get<ObjectStates>(state);
  if (states.tick != request.step().tick() || states.time.ns != request.step().time_ns() ||
      states.count != std::size_t(objects))
    __builtin_trap();
}

/// A run as it should be.
const std::string& sample() {
  static const std::string all = [] {
    std::string input;
    const auto add = [&](const v1::OwnNodeRequest& request, const std::string& environment) {
      fuzz::append(input, request.SerializeAsString());
      fuzz::append(input, environment);
    };
    v1::OwnNodeRequest request;
    v1::OwnNodeBegin& begin = *request.mutable_begin();
    begin.set_schema_version(wire_schema_version);
    begin.set_options_json(R"({"radius_m": 7e6})");
    begin.set_tick_ns(1'000'000'000);
    begin.set_last_tick(9);
    begin.set_period_ticks(1);
    begin.set_alive_every_s(1);
    begin.add_objects()->set_turned(true);
    begin.add_objects()->set_name("a");
    add(request, "");
    for (const test::Example& example : test::examples(1)) {
      const Encoded body = encode(example.state);
      if (body.kind != MessageKind::environment_state) continue;
      request.mutable_step()->set_tick(example.tick);
      request.mutable_step()->set_time_ns(example.tick * 1'000'000'000);
      request.mutable_step()->set_give_checkpoint(true);
      add(request, body.payload);
    }
    return input;
  }();
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parts = fuzz::cut(fuzz::view(data, size));
  double alive_every_s = 0.0;
  ActorSession session(
      [](const ActorTask& task) { return std::make_unique<ActorModelOf<Still>>(task); },
      [&](double every_s) { alive_every_s = every_s; });
  int objects = 0;
  try {
    for (std::size_t i = 0; i + 1 < parts.size(); i += 2) {
      std::vector<std::string_view> frames{parts[i]};
      if (!parts[i + 1].empty()) frames.push_back(parts[i + 1]);
      const auto answer = session.answer(frames);
      if (!answer) return 0;
      v1::OwnNodeRequest request;
      if (!request.ParseFromArray(parts[i].data(), int(parts[i].size()))) __builtin_trap();
      if (request.has_begin()) objects = request.begin().objects_size();
      require_answers(request, *answer, objects);
      if (!(alive_every_s > 0.0)) __builtin_trap();
    }
  } catch (const Error&) {  // the program's end
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  if ((size == 0 || seed % 64 == 0) && fuzz::place(sample(), data, &size, max_size)) return size;
  return seed % 4 == 0 ? LLVMFuzzerMutate(data, size, max_size)
                       : fuzz::mutate_part(data, size, max_size, seed / 4);
}
