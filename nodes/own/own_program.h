#pragma once
#include <sys/types.h>

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include <zmq.hpp>

#include "core/base/error.h"
#include "core/base/instant.h"
#include "core/sim/message.h"
#include "core/sim/state.h"
#include "dmise/v1/own_node.pb.h"
#include "nodes/own/private_endpoint.h"
#include "nodes/runtime/process/event.h"

namespace dmise {

/// The program has died or is silent: another process may take its place.
class ProgramLost : public Error {
 public:
  using Error::Error;
};

/// The program has ended by itself.
class ProgramEnded : public Error {
 public:
  using Error::Error;
};

/// How a program is started and how long it may be silent.
struct ProgramSettings {
  std::string name;                  // of the node
  std::vector<std::string> command;  // the first is the program's path
  std::string directory;             // in which it runs
  std::string log_path;              // of its output; empty: stderr of this process
  double start_within_s = 30.0;
  double silent_after_s = 5.0;
  const Event* stop = nullptr;  // ends the wait for an answer
};

/// A program of the user's as a child process, and what is said with it (docs/wire.md, Own nodes).
/// All functions throw `ProgramLost` or `ProgramEnded`, and `Error` for an answer that is not one
/// or says that the program failed.
class OwnProgram {
 public:
  using Frames = std::span<const std::string_view>;

  /// Starts the program, and tells it to begin; `more`: the frames after that.
  OwnProgram(const ProgramSettings& settings, v1::OwnNodeBegin begin, bool keep_log,
             Frames more = {});
  /// Ends it.
  ~OwnProgram();
  OwnProgram(const OwnProgram&) = delete;
  OwnProgram& operator=(const OwnProgram&) = delete;

  struct Stepped {
    ObjectStates states;
    std::uint64_t digest = 0;  // of the states as they came
    std::optional<std::string> checkpoint;
  };
  /// Asks for the states of a tick; false after the stop.
  bool ask(const v1::OwnNodeStep& step, const EnvironmentState& environment);
  /// Asks for those of a further tick before it has answered; false if it is not there any more.
  bool ask_ahead(const v1::OwnNodeStep& step, const EnvironmentState& environment);
  /// What it says of the first tick that it has not answered; nothing after the stop.
  std::optional<Stepped> stepped();
  /// What it finds in a frame with these counts; nothing after the stop.
  std::optional<v1::OwnNodeFound> find(const v1::OwnNodeFrame& frame, std::string_view counts);
  /// What it observes in an exposure; nothing after the stop. `more`: the frames after the request.
  std::optional<v1::OwnNodeObserved> observe(const v1::OwnNodeObserve& exposure, Frames more);

  struct Tracked {
    TrackSet tracks;
    std::optional<v1::OwnNodePoints> points;
    std::uint64_t digest = 0;  // of both as they came
    std::optional<std::string> checkpoint;
  };
  /// What it makes of a tick's exposures; nothing after the stop.
  std::optional<Tracked> track(const v1::OwnNodeTrack& track, Frames exposures);

 private:
  struct Answer {
    v1::OwnNodeAnswer head;
    std::vector<zmq::message_t> frames;
  };
  /// False while nobody is connected.
  bool try_to_send(const v1::OwnNodeRequest& request, Frames more = {});
  /// Waits until the program is connected; false after the stop.
  bool send(const v1::OwnNodeRequest& request, double within_s, Frames more = {});
  /// Asks, and returns the answer as `heard` does.
  std::optional<Answer> exchange(const v1::OwnNodeRequest& request, Frames more, const char* what,
                                 v1::OwnNodeAnswer::BodyCase wanted, std::size_t frames);
  /// The next answer, which must be of this kind and have this many frames; nothing after the stop.
  /// `what`: that it answers, for messages.
  std::optional<Answer> heard(const char* what, v1::OwnNodeAnswer::BodyCase wanted,
                              std::size_t frames);
  /// Waits for an answer; nothing after the stop.
  std::optional<Answer> answer(double within_s);
  void wait_until(short ready, std::chrono::milliseconds at_most);
  /// What came, if it is not a sign of life.
  std::optional<Answer> receive();
  bool stopped() const { return settings_.stop && settings_.stop->is_set(); }
  bool has_ended();
  /// Throws if the process has ended.
  void require_alive();
  [[noreturn]] void throw_end() const;
  std::string last_words() const;
  void end(int signal);

  ProgramSettings settings_;
  std::optional<PrivateEndpoint> endpoint_;  // until the program has connected
  zmq::context_t context_{1};
  zmq::socket_t socket_;
  pid_t pid_ = 0;     // 0: it has ended
  int status_ = 0;    // with which it has
  Instant heard_{0};  // when it last gave a sign of life
};

}  // namespace dmise
