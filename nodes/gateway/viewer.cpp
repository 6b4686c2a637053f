#include <algorithm>
#include <boost/beast/websocket.hpp>

#include "core/base/files/json.h"
#include "nodes/gateway/connection.h"

namespace dmise {
namespace {

namespace websocket = beast::websocket;
using Steady = std::chrono::steady_clock;

std::string to_json(std::string_view type, std::string_view text) {
  return JsonWriter().begin_object().field("type", type).field("text", text).end_object().take();
}

/// A viewer: a WebSocket.
class Viewer : public Connection, public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(Hub& hub, beast::tcp_stream stream, Access access)
      : Connection(hub.connections), hub_(hub), socket_(std::move(stream)), access_(access) {}

  void accept(const http::request<http::empty_body>& request) {
    beast::get_lowest_layer(socket_).expires_never();
    websocket::stream_base::timeout timeouts{};
    timeouts.handshake_timeout = milliseconds_of(hub_.options.request_within_s);
    timeouts.idle_timeout = milliseconds_of(hub_.options.idle_s);
    timeouts.keep_alive_pings = true;
    socket_.set_option(timeouts);
    socket_.read_message_max(max_command_bytes);
    request_ = request;
    socket_.async_accept(request_, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->open_ = true;
      JsonWriter json;
      json.begin_object().field("type", "welcome");
      json.field("may_control", self->access_ == Access::control);
      json.field("sees_truth", self->sees_truth()).end_object();
      self->answer(json.take());
      self->read();
      self->pump();
    });
  }

  /// Sends the next message, if none is on its way.
  void pump() override {
    if (!open_ || sending_) return;
    SharedMessage next = std::exchange(answer_, nullptr);
    if (!next && !past_.empty()) {
      next = past_.back();
      past_.pop_back();
    }
    if (!next) next = newest();
    if (!next) return;
    sending_ = next;
    socket_.binary(next->binary);
    socket_.async_write(boost::asio::buffer(next->bytes),
                        [self = shared_from_this()](error_code error, std::size_t) {
                          self->sending_.reset();
                          if (error) {
                            self->open_ = false;
                            return;
                          }
                          self->pump();
                        });
  }

 private:
  /// The newest message of a kind that this viewer does not have yet, the kinds in turn.
  SharedMessage newest() {
    const auto slots = hub_.content.latest.all();
    for (std::size_t i = 0; i < slot_count; ++i) {
      const std::size_t slot = (next_slot_ + i) % slot_count;
      if (!slots[slot].message || slots[slot].version == sent_[slot]) continue;
      if (in_past_ && is_in_history(MessageSlot(slot))) continue;
      if (MessageSlot(slot) == MessageSlot::truth && !sees_truth()) continue;
      sent_[slot] = slots[slot].version;
      next_slot_ = (slot + 1) % slot_count;
      return slots[slot].message;
    }
    return nullptr;
  }

  bool sees_truth() const { return access_ >= Access::truth && hub_.options.shows_truth; }

  static bool is_in_history(MessageSlot slot) {
    return std::ranges::find(slots_of_history, slot) != std::end(slots_of_history);
  }

  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) {
        self->open_ = false;
        return;
      }
      self->take();
      self->read();
    });
  }

  void take() {
    const std::string text = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    if (!admits()) return;
    std::visit([this](const auto& command) { obey(command); }, parse_viewer_command(text));
    pump();
  }

  /// Limits the rate of commands; those beyond are dropped.
  bool admits() {
    const auto at = Steady::now();
    if (at - second_ >= std::chrono::seconds(1)) second_ = at, commands_ = 0;
    return ++commands_ <= hub_.options.max_commands_per_s;
  }

  void obey(const CommandError& error) { answer(to_json("refused", error.reason)); }
  void obey(const LiveCommand&) {
    in_past_ = false;
    past_.clear();
    for (const MessageSlot slot : slots_of_history) sent_[std::size_t(slot)] = 0;
  }
  void obey(const PastCommand& command) {
    const auto snapshot = hub_.content.history.at(command.time_s);
    if (!snapshot) return answer(to_json("refused", "nothing is kept of the past yet"));
    in_past_ = true;
    past_ = snapshot->messages;
    answer(JsonWriter()
               .begin_object()
               .field("type", "past")
               .field("time_s", snapshot->time_s)
               .end_object()
               .take());
  }
  void obey(const ClockCommand& command) {
    if (access_ != Access::control)
      return answer(to_json("refused", "only the operator controls the clock"));
    if (!hub_.content.control(command))
      answer(to_json("refused", "too many commands wait for the clock"));
  }
  /// Only the last of several answers that wait is sent.
  void answer(std::string json) {
    answer_ = std::make_shared<const ViewerMessage>(ViewerMessage{std::move(json)});
  }

  Hub& hub_;
  websocket::stream<beast::tcp_stream> socket_;
  http::request<http::empty_body> request_;
  Access access_;
  beast::flat_buffer buffer_{max_command_bytes};
  std::array<std::uint64_t, slot_count> sent_{};
  std::size_t next_slot_ = 0;
  bool open_ = false, in_past_ = false;
  SharedMessage sending_, answer_;
  std::vector<SharedMessage> past_;
  Steady::time_point second_{};
  std::size_t commands_ = 0;
};

}  // namespace

void serve_viewer(Hub& hub, beast::tcp_stream stream,
                  const http::request<http::empty_body>& request, Access access) {
  std::make_shared<Viewer>(hub, std::move(stream), access)->accept(request);
}

}  // namespace dmise
