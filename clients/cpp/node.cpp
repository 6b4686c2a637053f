#include "clients/cpp/node.h"

#include <zmq.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>
#include <zmq.hpp>

#include "clients/cpp/actor_session.h"
#include "core/base/error.h"
#include "core/base/printable.h"
#include "dmise/v1/own_node.pb.h"
#include "nodes/runtime/transport/socket.h"
#include "nodes/wire/own_node.h"

namespace dmise {
namespace {

constexpr int linger_ms = 1000;  // for the last answer
constexpr const char* lost_address = "inproc://lost";
constexpr std::chrono::hours look_every{1};

std::string failed(const std::string& reason) {
  v1::OwnNodeAnswer answer;
  answer.set_failed(printable(reason));
  return answer.SerializeAsString();
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

/// What is said with the run, and by whom.
class Conversation {
 public:
  Conversation(const std::string& address, const MakeActor& make);
  void run();

 private:
  /// The next request; empty if the run is gone.
  std::vector<zmq::message_t> next();
  void send(const std::vector<std::string>& frames);

  zmq::context_t context_{1};
  zmq::socket_t socket_, lost_;
  ActorSession session_;
  SignsOfLife life_{socket_};
};

Conversation::Conversation(const std::string& address, const MakeActor& make)
    : socket_(make_socket(context_, zmq::socket_type::pair, max_data_bytes)),
      lost_(make_socket(context_, zmq::socket_type::pair, max_control_bytes)),
      session_(make, [this](double every_s) { life_.begin(every_s); }) {
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
    life_.set_working(true);
    try {
      const auto answer = session_.answer(views(frames));
      if (!answer) return;
      send(*answer);
    } catch (...) {
      const std::string reason = reason_of_current_exception();
      send({failed(reason)});
      throw Error(reason);
    }
  }
}

void Conversation::send(const std::vector<std::string>& frames) {
  life_.set_working(false);
  for (const std::string& frame : frames)
    socket_.send(zmq::buffer(frame),
                 &frame != &frames.back() ? zmq::send_flags::sndmore : zmq::send_flags::none);
}

const nlohmann::json& option_of(const ActorTask& task, const std::string& name) {
  const auto found = task.options.find(name);
  if (found == task.options.end()) throw Error("option " + name + ": is missing");
  return *found;
}

[[noreturn]] void refuse(const std::string& name, const char* form, const nlohmann::json& value) {
  throw Error("option " + name + ": must be " + form + ", got " + printable(value.dump(), 40));
}

}  // namespace

double ActorTask::number(const std::string& option) const {
  const nlohmann::json& value = option_of(*this, option);
  if (!value.is_number()) refuse(option, "a number", value);
  return value.get<double>();
}

Vec<Gcrs> ActorTask::vector(const std::string& option) const {
  const nlohmann::json& value = option_of(*this, option);
  const auto is_number = [](const nlohmann::json& item) { return item.is_number(); };
  if (!value.is_array() || value.size() != 3 || !std::ranges::all_of(value, is_number))
    refuse(option, "a list of 3 numbers", value);
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

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
