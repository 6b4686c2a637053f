#include "nodes/gateway/frame_previews.h"

#include <spdlog/spdlog.h>

#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/image/charts/picture.h"
#include "core/image/fits_file.h"
#include "core/pictures/picture_file.h"
#include "nodes/runtime/process/event.h"
#include "nodes/runtime/process/limited_log.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/security/security.h"
#include "nodes/runtime/transport/socket.h"

namespace dmise {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int picture_columns = 1024;
constexpr std::int64_t max_fits_bytes = std::int64_t(256) << 20;
constexpr std::size_t kept_bytes = std::size_t(32) << 20;
constexpr seconds patience{2};        // with a sensor, before the directory is searched
constexpr seconds connected_for{60};  // after the last request: a sensor encodes frames meanwhile

using FrameKey = std::pair<std::string, std::uint32_t>;  // sensor, number

/// The last previews.
class PreviewCache {
 public:
  void add(const FrameKey& frame, SharedPreview png) {
    bytes_ += png->size();
    order_.push_back(frame);
    previews_[frame] = std::move(png);
    while (bytes_ > kept_bytes && order_.size() > 1) {
      bytes_ -= previews_.at(order_.front())->size();
      previews_.erase(order_.front());
      order_.pop_front();
    }
  }
  SharedPreview find(const FrameKey& frame) const {
    const auto found = previews_.find(frame);
    return found == previews_.end() ? nullptr : found->second;
  }
  void clear() { *this = PreviewCache(); }

 private:
  std::map<FrameKey, SharedPreview> previews_;
  std::deque<FrameKey> order_;
  std::size_t bytes_ = 0;
};

}  // namespace

std::string draw_preview(std::string_view fits) {
  const Frame frame = decode_frame(fits, "frame");
  return encode_picture(preview(frame.counts, picture_columns).picture, "png");
}

struct FramePreviews::Work {
  struct Request {
    FrameKey frame;
    Answer answer;
  };
  struct Wanted {
    std::uint32_t frame = 0;
    std::vector<Answer> answers;
  };
  /// Requests to one sensor; one at a time is sent, as its endpoint requires.
  struct Line {
    std::string endpoint;
    std::optional<zmq::socket_t> socket;
    std::deque<Wanted> wanted;     // the first is asked for
    std::optional<Instant> asked;  // empty: not yet
    Instant used{0};
    bool silent = false;  // gave no answer: the directory is searched first
  };

  Work(const std::string& keys, const std::string& name, std::string run_directory)
      : security(keys, name), directory(std::move(run_directory)), thread([this] { run(); }) {}
  ~Work() {
    quit.set();
    news.set();
    thread.join();
  }

  void run() {
    while (!quit.is_set()) {
      wait();
      take_news();
      const Instant present = now();
      for (auto& [sensor, line] : lines) {
        receive(sensor, line);
        if (line.asked && present - *line.asked > patience) miss(sensor, line);
        ask(sensor, line);
        if (line.wanted.empty() && present - line.used > connected_for) line.socket.reset();
      }
      log.sum_up();
    }
  }

  void wait() {
    std::vector<zmq::pollitem_t> items{{nullptr, news.fd(), ZMQ_POLLIN, 0}};
    bool asked = false;
    for (auto& [sensor, line] : lines) {
      if (line.socket) items.push_back({line.socket->handle(), 0, ZMQ_POLLIN, 0});
      asked |= line.asked.has_value();
    }
    wait_for(items, asked ? milliseconds(100) : milliseconds(1000));
  }

  void take_news() {
    std::vector<Request> requests;
    std::optional<std::pair<std::uint64_t, std::map<std::string, std::string>>> followed;
    {
      const std::lock_guard lock(mutex);
      news.clear();
      requests = std::exchange(waiting, {});
      followed = std::exchange(told, std::nullopt);
    }
    if (followed) follow(followed->first, followed->second);
    for (Request& request : requests) want(std::move(request));
  }

  void follow(std::uint64_t run, const std::map<std::string, std::string>& endpoints) {
    if (run != run_id) cache.clear();
    for (auto at = lines.begin(); at != lines.end();) {
      const auto& [sensor, line] = *at;
      const auto found = endpoints.find(sensor);
      const bool same = run == run_id && found != endpoints.end() && found->second == line.endpoint;
      if (!same) give_up(sensor, at->second);
      at = same ? std::next(at) : lines.erase(at);
    }
    run_id = run;
    for (const auto& [sensor, endpoint] : endpoints) lines[sensor].endpoint = endpoint;
  }

  void want(Request request) {
    const auto& [sensor, frame] = request.frame;
    if (SharedPreview png = cache.find(request.frame)) return request.answer(png);
    const auto at = lines.find(sensor);
    if (at == lines.end() || at->second.silent)
      if (SharedPreview png = read_preview(directory, sensor, frame)) return request.answer(png);
    if (at == lines.end() || frame == 0) return request.answer(nullptr);  // they count from 1
    for (Wanted& wanted : at->second.wanted)
      if (wanted.frame == frame) return wanted.answers.push_back(std::move(request.answer));
    at->second.wanted.push_back({frame, {std::move(request.answer)}});
  }

  void ask(const std::string& sensor, Line& line) {
    if (line.wanted.empty() || line.asked) return;
    try {
      if (!line.socket) {
        line.socket.emplace(make_socket(context, zmq::socket_type::dealer, max_fits_bytes));
        connect_to(*line.socket, line.endpoint, security, sensor);
      }
    } catch (const Error& error) {
      log.warn("sensors", std::string("no frames: ") + error.what());
      line.socket.reset();
      return give_up(sensor, line);
    }
    v1::FrameRequest question;
    question.set_run_id(run_id);
    question.set_frame(line.wanted.front().frame);
    line.socket->send(to_frame(question), zmq::send_flags::dontwait);
    line.asked = line.used = now();
  }

  void receive(const std::string& sensor, Line& line) {
    while (line.socket) {
      const auto message = dmise::receive(*line.socket);
      if (message.empty()) return;
      v1::FrameAnswer head;
      if (!line.asked || !from_frame(message[0], &head) || head.run_id() != run_id) continue;
      line.silent = false;
      SharedPreview png;
      if (head.status() == v1::FrameAnswer::STATUS_SENT && message.size() == 2) {
        if (head.report().frame() != line.wanted.front().frame) continue;
        png = draw(sensor, head.report().frame(), message[1]);
      }
      settle(sensor, line, png);
    }
  }

  SharedPreview draw(const std::string& sensor, std::uint32_t frame, const zmq::message_t& fits) {
    try {
      auto png = std::make_shared<const std::string>(
          draw_preview({static_cast<const char*>(fits.data()), fits.size()}));
      cache.add({sensor, frame}, png);
      return png;
    } catch (const Error& error) {
      log.warn("previews", "no preview of " + sensor + ": " + error.what());
      return nullptr;
    }
  }

  /// Answers all requests for the first frame of the queue, without `png` from the directory.
  void settle(const std::string& sensor, Line& line, SharedPreview png) {
    const Wanted wanted = std::move(line.wanted.front());
    line.wanted.pop_front();
    line.asked.reset();
    if (!png) png = read_preview(directory, sensor, wanted.frame);
    for (const Answer& answer : wanted.answers) answer(png);
  }

  void miss(const std::string& sensor, Line& line) {
    line.silent = true;
    line.socket.reset();  // its answer, if it still comes, is to an earlier question
    give_up(sensor, line);
  }

  void give_up(const std::string& sensor, Line& line) {
    while (!line.wanted.empty()) settle(sensor, line, nullptr);
  }

  Security security;
  std::string directory;  // where the run is
  zmq::context_t context{1};
  std::map<std::string, Line> lines;  // by sensor
  std::uint64_t run_id = 0;
  PreviewCache cache;
  LimitedLog log;
  std::mutex mutex;  // guards `waiting` and `told`
  std::vector<Request> waiting;
  std::optional<std::pair<std::uint64_t, std::map<std::string, std::string>>> told;
  Event news, quit;
  std::thread thread;  // last: it uses all of the above
};

FramePreviews::FramePreviews(const std::string& keys, const std::string& name,
                             std::string directory)
    : work_(std::make_unique<Work>(keys, name, std::move(directory))) {}

FramePreviews::~FramePreviews() = default;

void FramePreviews::follow(std::uint64_t run_id, std::map<std::string, std::string> endpoints) {
  const std::lock_guard lock(work_->mutex);
  work_->told.emplace(run_id, std::move(endpoints));
  work_->news.set();
}

void FramePreviews::request(const std::string& sensor, std::uint32_t frame, Answer answer) {
  const std::lock_guard lock(work_->mutex);
  work_->waiting.push_back({{sensor, frame}, std::move(answer)});
  work_->news.set();
}

}  // namespace dmise
