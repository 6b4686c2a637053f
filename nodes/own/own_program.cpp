#include "nodes/own/own_program.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <thread>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "nodes/runtime/process/last_line.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/process/seconds.h"
#include "nodes/runtime/process/spawn.h"
#include "nodes/runtime/transport/socket.h"
#include "nodes/wire/own_node.h"

namespace dmise {
namespace {

constexpr std::size_t longest_directory = 80;  // the address of a local socket has 107 characters

std::string place_for_temporary_files() {
  std::error_code error;
  const std::string path = std::filesystem::temp_directory_path(error).string();
  return error || path.size() > longest_directory ? "/tmp" : path;
}

using std::chrono::milliseconds;

constexpr milliseconds look_every{20};          // for the end of the process
constexpr milliseconds last_words_within{200};  // after a process has ended
constexpr milliseconds time_to_end{500};
constexpr double working_within_s = 900.0;  // longest work on one answer
constexpr double alive_every_share = 0.2;   // share of the time after which it is silent
constexpr double longest_alive_every_s = 1.0;

std::string seconds_text(double seconds) {
  std::string text = std::to_string(seconds);
  text.resize(text.find('.') + 2);
  return text + " s";
}

std::string end_text(int status) {
  if (WIFSIGNALED(status))
    return std::string("its program was killed (") + strsignal(WTERMSIG(status)) + ")";
  return "its program has ended with code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

PrivateEndpoint::PrivateEndpoint() : directory_(place_for_temporary_files() + "/dmise-XXXXXX") {
  if (!mkdtemp(directory_.data()))
    throw Error(directory_ + ": can't be made: " + std::strerror(errno));
}

PrivateEndpoint::~PrivateEndpoint() {
  unlink(path().c_str());
  rmdir(directory_.c_str());
}

/// What an ended program has said last, and where.
std::string OwnProgram::last_words() const {
  const bool forgot = endpoint_ && WEXITSTATUS(status_) == 0;
  const std::string question = forgot ? ": does it call dmise.serve?" : "";
  if (settings_.log_path.empty()) return question;
  const std::string line = printable(last_line(settings_.log_path));
  return question + (line.empty() ? "" : ": " + line) + " (" + settings_.log_path + ")";
}

OwnProgram::OwnProgram(const ProgramSettings& settings, v1::OwnNodeBegin begin, bool keep_log,
                       Frames more)
    : settings_(settings),
      endpoint_(std::in_place),
      socket_(make_socket(context_, zmq::socket_type::pair, max_data_bytes)) {
  bind_to(socket_, endpoint_->address());
  pid_ = spawn({.name = settings.name,
                .arguments = settings.command,
                .log_path = settings.log_path,
                .keep_log = keep_log,
                .directory = settings.directory,
                .environment = {std::string(own_node_variable) + "=" + endpoint_->address()},
                .own_group = true});
  begin.set_schema_version(wire_schema_version);
  begin.set_node(settings.name);
  begin.set_alive_every_s(
      std::min(longest_alive_every_s, alive_every_share * settings.silent_after_s));
  v1::OwnNodeRequest request;
  *request.mutable_begin() = std::move(begin);
  try {
    if (!send_within(settings.start_within_s, request, more)) return;
    const auto got = answer_within(settings.start_within_s);
    if (got && !got->head.has_ready()) throw Error("its program does not say that it is ready");
  } catch (...) {
    end(SIGKILL);
    throw;
  }
  endpoint_.reset();
}

OwnProgram::~OwnProgram() {
  if (pid_ == 0) return;
  try {
    v1::OwnNodeRequest request;
    request.mutable_end();
    try_to_send(request);
  } catch (const std::exception&) {  // it is ended anyway
  }
  for (const auto until = now() + time_to_end; now() < until;) {
    if (waitpid(pid_, nullptr, WNOHANG) == pid_) {
      pid_ = 0;
      return;
    }
    std::this_thread::sleep_for(milliseconds(2));
  }
  end(SIGKILL);
}

void OwnProgram::end(int signal) {
  if (pid_ == 0) return;
  kill(-pid_, signal);  // with what it has started
  kill(pid_, signal);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  pid_ = 0;
}

bool OwnProgram::try_to_send(const v1::OwnNodeRequest& request, Frames more) {
  using zmq::send_flags;
  const auto part = [&](std::size_t left) { return left ? send_flags::sndmore : send_flags::none; };
  if (!socket_.send(to_frame(request), part(more.size()) | send_flags::dontwait)) return false;
  for (std::size_t i = 0; i < more.size(); ++i)
    socket_.send(zmq::buffer(more[i].data(), more[i].size()), part(more.size() - 1 - i));
  return true;
}

bool OwnProgram::send_within(double within_s, const v1::OwnNodeRequest& request, Frames more) {
  const Instant begun = now();
  while (!stopped()) {
    if (try_to_send(request, more)) return true;
    wait_until(ZMQ_POLLOUT, look_every);
    require_alive();
    if (to_seconds(now() - begun) > within_s)
      throw ProgramLost("its program has not been connected for " + seconds_text(within_s));
  }
  return false;
}

void OwnProgram::wait_until(short ready, std::chrono::milliseconds at_most) {
  std::vector<zmq::pollitem_t> items{{socket_.handle(), 0, ready, 0}};
  wait_for(items, at_most);
}

std::optional<OwnProgram::Answer> OwnProgram::receive() {
  while (true) {
    const auto message =
        std::make_shared<const std::vector<zmq::message_t>>(dmise::receive(socket_));
    if (message->empty()) return std::nullopt;
    heard_ = now();
    Answer answer = answer_in(views(*message), message);
    if (!answer.head.has_alive()) return answer;
  }
}

bool OwnProgram::has_ended() {
  if (pid_ != 0 && waitpid(pid_, &status_, WNOHANG) == pid_) {
    pid_ = 0;
    wait_until(ZMQ_POLLIN, last_words_within);
  }
  return pid_ == 0;
}

void OwnProgram::throw_end() const {
  if (WIFSIGNALED(status_)) throw ProgramLost(end_text(status_));
  throw ProgramEnded(end_text(status_) + (endpoint_ ? " before it was ready" : "") + last_words());
}

void OwnProgram::require_alive() {
  if (!has_ended()) return;
  receive();  // throws if it said why
  throw_end();
}

std::optional<OwnProgram::Answer> OwnProgram::answer_within(double within_s) {
  const Instant asked = heard_ = now();
  for (Instant awake = asked; !stopped(); awake = now()) {
    wait_until(ZMQ_POLLIN, look_every);
    if (auto got = receive()) return got;
    if (has_ended()) {
      if (auto got = receive()) return got;
      throw_end();
    }
    // While this process was suspended it could not hear anything.
    if (to_seconds(now() - awake) > 0.5 * settings_.silent_after_s) heard_ = now();
    const double silent_s = to_seconds(now() - heard_);
    if (silent_s > (endpoint_ ? within_s : settings_.silent_after_s))
      throw ProgramLost("its program has not answered for " + seconds_text(silent_s));
    if (to_seconds(now() - asked) > within_s)
      throw ProgramLost("its program works on one answer for longer than " +
                        seconds_text(within_s));
  }
  return std::nullopt;
}

std::optional<OwnProgram::Answer> OwnProgram::answer() { return answer_within(working_within_s); }

std::unique_ptr<OwnModel> start_program(const ModelBeginning& beginning) {
  const auto& [scenario, node, settings, begin, again, more] = beginning;
  ProgramSettings program{.name = node.name,
                          .command = node.run,
                          .directory = node.directory,
                          .log_path = settings.log_path,
                          .start_within_s = scenario.network.join_within_s,
                          .silent_after_s = scenario.network.silent_after_s,
                          .stop = settings.stop};
  program.command[0] = program_of(node);
  return std::make_unique<OwnProgram>(program, begin, again, more);
}

}  // namespace dmise
