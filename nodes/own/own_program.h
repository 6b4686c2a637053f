#pragma once
#include <sys/types.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "core/base/instant.h"
#include "nodes/own/own_model.h"
#include "nodes/own/own_node_run.h"
#include "nodes/runtime/process/event.h"

namespace dmise {

/// An address of this machine that only this user can connect to: a socket in a directory of its
/// own, which is removed with this object. Connections last.
class PrivateEndpoint {
 public:
  /// Throws `Error` if there is no place for temporary files.
  PrivateEndpoint();
  ~PrivateEndpoint();
  PrivateEndpoint(const PrivateEndpoint&) = delete;
  PrivateEndpoint& operator=(const PrivateEndpoint&) = delete;

  std::string address() const { return "ipc://" + path(); }

 private:
  std::string path() const { return directory_ + "/socket"; }
  std::string directory_;
};

/// How a program is started and how long it may be silent.
struct ProgramSettings {
  std::string name;                  // name of the node
  std::vector<std::string> command;  // the first is the program's path
  std::string directory;             // in which it runs
  std::string log_path;              // where its output goes; empty: stderr of this process
  double start_within_s = 30.0;
  double silent_after_s = 5.0;
  const Event* stop = nullptr;  // ends the wait for an answer
};

/// A program of the user's as a child process. All functions throw `ProgramLost` or `ProgramEnded`
/// as well.
class OwnProgram : public OwnModel {
 public:
  /// Starts the program, and tells it to begin; `more`: the frames after that.
  OwnProgram(const ProgramSettings& settings, v1::OwnNodeBegin begin, bool keep_log,
             Frames more = {});
  /// Ends it.
  ~OwnProgram() override;
  OwnProgram(const OwnProgram&) = delete;
  OwnProgram& operator=(const OwnProgram&) = delete;

 private:
  /// False while nobody is connected.
  bool try_to_send(const v1::OwnNodeRequest& request, Frames more = {});
  /// Waits until the program is connected; false after the stop.
  bool send_within(double within_s, const v1::OwnNodeRequest& request, Frames more);
  bool send(const v1::OwnNodeRequest& request, Frames more) override {
    return send_within(settings_.silent_after_s, request, more);
  }
  bool send_ahead(const v1::OwnNodeRequest& request, Frames more) override {
    return try_to_send(request, more);
  }
  std::optional<Answer> answer() override;
  /// Waits for an answer; nothing after the stop.
  std::optional<Answer> answer_within(double within_s);
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

/// Starts the program of a node; a `ModelStarter`.
std::unique_ptr<OwnModel> start_program(const ModelBeginning& beginning);

}  // namespace dmise
