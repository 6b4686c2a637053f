#include "clients/cpp/node.h"

#include <zmq.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <mutex>
#include <stop_token>
#include <thread>
#include <zmq.hpp>

#include "clients/cpp/said_states.h"
#include "core/base/error.h"
#include "core/base/printable.h"
#include "dmise/v1/own_node.pb.h"
#include "nodes/runtime/transport/socket.h"
#include "nodes/wire/envelope.h"
#include "nodes/wire/own_node.h"
#include "nodes/wire/state_codec.h"

namespace dmise {
namespace {

constexpr int linger_ms = 1000;  // for the last answer
constexpr const char* lost_address = "inproc://lost";
constexpr std::chrono::hours look_every{1};

using Answer = std::vector<zmq::message_t>;

zmq::message_t frame_of(const std::string& bytes) { return {bytes.data(), bytes.size()}; }

Answer answer_of(const v1::OwnNodeAnswer& head) {
  Answer frames;
  frames.push_back(to_frame(head));
  return frames;
}

Answer failed(const std::string& reason) {
  v1::OwnNodeAnswer answer;
  answer.set_failed(printable(reason));
  return answer_of(answer);
}

Answer ready() {
  v1::OwnNodeAnswer answer;
  answer.mutable_ready();
  return answer_of(answer);
}

zmq::message_t alive() {
  v1::OwnNodeAnswer answer;
  answer.mutable_alive();
  return to_frame(answer);
}

std::string reason_of_current_exception() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "its model throws what is no std::exception";
  }
}

/// Sends `alive` while the program works on an answer, which is when nobody else uses the socket.
class SignsOfLife {
 public:
  explicit SignsOfLife(zmq::socket_t& socket) : socket_(socket) {}

  void begin(double every_s) {
    const std::chrono::duration<double> every(every_s);
    thread_ = std::jthread([this, every](const std::stop_token& stop) { show(stop, every); });
  }
  void set_working(bool working) {
    const std::scoped_lock lock(mutex_);
    working_ = working;
  }

 private:
  void show(const std::stop_token& stop, std::chrono::duration<double> every) {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, stop, every, [&] { return stop.stop_requested(); }) &&
           !stop.stop_requested())
      if (working_) socket_.send(alive(), zmq::send_flags::none);
  }

  zmq::socket_t& socket_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  bool working_ = false;
  std::jthread thread_;
};

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
  if (!task.options.is_object()) throw Error("begin: options_json: must be one JSON object");
  if (task.tick.ns <= 0) throw Error("begin: tick_ns: must be > 0");
  if (task.last_tick < 0) throw Error("begin: last_tick: must be >= 0");
  if (task.period_ticks < 1) throw Error("begin: period_ticks: must be >= 1");
  const double every_s = begin.alive_every_s();
  if (!(every_s > 0 && every_s <= 1e6)) throw Error("begin: alive_every_s: must be in (0, 1e6]");
}

/// What is said with the run, and by whom.
class Conversation {
 public:
  Conversation(const std::string& address, const MakeActor& make);
  void run();

 private:
  /// The next request; empty if the run is gone.
  std::vector<zmq::message_t> next();
  Answer answer(const v1::OwnNodeRequest& request, const std::vector<zmq::message_t>& frames);
  Answer begin(const v1::OwnNodeBegin& begin);
  Answer step(const v1::OwnNodeStep& step, std::string_view environment);
  void send(Answer frames);

  const MakeActor& make_;
  zmq::context_t context_{1};
  zmq::socket_t socket_, lost_;
  v1::OwnNodeBegin begun_;
  ActorTask task_;
  std::unique_ptr<ActorModel> model_;
  SignsOfLife life_{socket_};
};

Conversation::Conversation(const std::string& address, const MakeActor& make)
    : make_(make),
      socket_(make_socket(context_, zmq::socket_type::pair, max_data_bytes)),
      lost_(make_socket(context_, zmq::socket_type::pair, max_control_bytes)) {
  socket_.set(zmq::sockopt::linger, linger_ms);
  socket_.set(zmq::sockopt::reconnect_ivl, -1);
  if (zmq_socket_monitor(socket_.handle(), lost_address, ZMQ_EVENT_DISCONNECTED) != 0)
    throw Error("can't watch the connection");
  lost_.connect(lost_address);
  connect_to(socket_, address);
}

std::vector<zmq::message_t> Conversation::next() {
  std::vector<zmq::pollitem_t> items{{socket_.handle(), 0, ZMQ_POLLIN, 0},
                                     {lost_.handle(), 0, ZMQ_POLLIN, 0}};
  while (true) {
    wait_for(items, look_every);
    auto frames = receive(socket_);
    if (!frames.empty() || items[1].revents) return frames;
  }
}

void Conversation::run() {
  for (auto frames = next(); !frames.empty(); frames = next()) {
    v1::OwnNodeRequest request;
    life_.set_working(true);
    try {
      if (!from_frame(frames[0], &request) ||
          request.body_case() == v1::OwnNodeRequest::BODY_NOT_SET)
        throw Error("what the run says is no request (" + std::to_string(frames[0].size()) +
                    " bytes)");
      if (request.has_end()) return;
      send(answer(request, frames));
    } catch (...) {
      const std::string reason = reason_of_current_exception();
      send(failed(reason));
      throw Error(reason);
    }
  }
}

Answer Conversation::answer(const v1::OwnNodeRequest& request,
                            const std::vector<zmq::message_t>& frames) {
  if (request.has_begin()) return begin(request.begin());
  if (!request.has_step()) throw Error("the run asks for what is no state of objects");
  if (!model_) throw Error("the run asks for a step before it begins");
  if (frames.size() != 2)
    throw Error("a step: must have 2 frames, got " + std::to_string(frames.size()));
  return step(request.step(), frames[1].to_string_view());
}

Answer Conversation::begin(const v1::OwnNodeBegin& begin) {
  if (model_) throw Error("the run begins twice");
  task_ = task_of(begin);
  check(begin, task_);
  begun_ = begin;
  life_.begin(begin.alive_every_s());
  model_ = make_(task_);
  if (begin.has_checkpoint()) model_->restore(begin.checkpoint());
  return ready();
}

Answer Conversation::step(const v1::OwnNodeStep& step, std::string_view environment) {
  ActorWorld world{.task = task_, .tick = step.tick(), .time = {step.time_ns()}, .environment = {}};
  world.environment =
      std::get<EnvironmentState>(decode(MessageKind::environment_state, environment, {}));
  if (world.environment.tick != world.tick)
    throw Error("a step: must have the environment of its tick, got that of tick " +
                std::to_string(world.environment.tick));
  const Encoded states = encode(said_states(model_->step(world), begun_, world.tick, world.time));
  v1::OwnNodeAnswer answer;
  v1::OwnNodeStepped& stepped = *answer.mutable_stepped();
  if (step.give_checkpoint())
    if (auto checkpoint = model_->checkpoint()) stepped.set_checkpoint(std::move(*checkpoint));
  Answer frames = answer_of(answer);
  frames.push_back(frame_of(states.payload));
  frames.push_back(frame_of(states.arrays));
  return frames;
}

void Conversation::send(Answer frames) {
  life_.set_working(false);
  for (std::size_t i = 0; i < frames.size(); ++i)
    socket_.send(frames[i],
                 i + 1 < frames.size() ? zmq::send_flags::sndmore : zmq::send_flags::none);
}

}  // namespace

void refuse_checkpoint() { throw Error("its model has no restore, for the checkpoint of the run"); }

int serve_actor(const MakeActor& make, const std::string& program) {
  try {
    const char* address = std::getenv(own_node_variable);
    if (!address || !*address)
      throw Error(std::string(own_node_variable) +
                  " is not set: this program is started by a scenario with nodes: [{name: .., run: "
                  "[..]}], or by dmise join SCENARIO NAME --program ..");
    Conversation(address, make).run();
    return 0;
  } catch (const std::exception& error) {
    const std::string name = std::filesystem::path(program).filename().string();
    std::fprintf(stderr, "%s: %s\n", name.c_str(), printable(error.what()).c_str());
    return 1;
  }
}

}  // namespace dmise
