#include "nodes/gateway/web_server.h"

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <set>
#include <thread>

#include "core/base/error.h"
#include "core/base/json.h"

namespace dmise {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = boost::asio::ip::tcp;
using boost::system::error_code;
using Steady = std::chrono::steady_clock;

constexpr std::size_t max_head_bytes = 8192;
constexpr int send_buffer_bytes = 256 << 10;  // of a connection, in the kernel
constexpr const char* cookie_name = "dmise_token";

// Only what comes from this server is loaded. Cesium compiles WebAssembly and begins its workers
// from blobs; elements get their styles by script.
constexpr const char* content_policy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval' blob:; worker-src 'self' blob:; "
    "style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self'; "
    "connect-src 'self' ws: wss:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

constexpr const char* no_dashboard =
    "<!doctype html><html lang='en'><meta charset='utf-8'><title>DMISE live view</title>"
    "<h1>The dashboard is not built</h1><p>The gateway runs, and has no pages to show. "
    "<code>./dmise dashboard</code> builds them: it needs npm.</p></html>";

std::chrono::milliseconds milliseconds_of(double seconds) {
  return std::chrono::milliseconds(std::int64_t(seconds * 1e3));
}

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

class Connection;

/// What all connections share; used on the server's thread alone.
struct Hub {
  WebServerOptions options;
  WebContent content;
  std::set<Connection*> connections;
};

class Connection {
 public:
  virtual ~Connection() = default;
  virtual void pump() {}
};

std::string to_json(std::string_view type, std::string_view text) {
  return JsonWriter().begin_object().field("type", type).field("text", text).end_object().take();
}

/// A viewer: a WebSocket.
class Viewer : public Connection, public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(Hub& hub, beast::tcp_stream stream, Access access)
      : hub_(hub), socket_(std::move(stream)), access_(access) {
    hub_.connections.insert(this);
  }
  ~Viewer() override { hub_.connections.erase(this); }

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
      json.field("may_control", self->access_ == Access::control).end_object();
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
    if (next->binary)
      socket_.binary(true);
    else
      socket_.text(true);
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
      sent_[slot] = slots[slot].version;
      next_slot_ = (slot + 1) % slot_count;
      return slots[slot].message;
    }
    return nullptr;
  }

  static bool is_in_history(MessageSlot slot) {
    return slot != MessageSlot::run && slot != MessageSlot::status && slot != MessageSlot::roster &&
           slot != MessageSlot::notice;
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
    return ++commands_ <= hub_.options.most_commands_per_s;
  }

  void obey(const CommandError& error) { answer(to_json("refused", error.reason)); }
  void obey(const LiveCommand&) {
    in_past_ = false;
    past_.clear();
    for (std::size_t slot = 0; slot < slot_count; ++slot)
      if (is_in_history(MessageSlot(slot))) sent_[slot] = 0;
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
  /// Of several answers that wait, the last is sent.
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

/// A connection of HTTP, until it becomes a viewer's.
class Visitor : public Connection, public std::enable_shared_from_this<Visitor> {
 public:
  Visitor(Hub& hub, tcp::socket socket) : hub_(hub), stream_(std::move(socket)) {
    hub_.connections.insert(this);
  }
  ~Visitor() override { hub_.connections.erase(this); }

  void read() {
    parser_.emplace();
    parser_->header_limit(max_head_bytes);
    parser_->body_limit(0);
    stream_.expires_after(milliseconds_of(hub_.options.request_within_s));
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](error_code error, std::size_t) {
                       if (!error) self->take();
                     });
  }

 private:
  using Answer = http::response<http::string_body>;

  void take() {
    const auto& request = parser_->get();
    const std::string_view host = view_of(request[http::field::host]);
    // Of a name that is not loopback's, a foreign page could make this server its own.
    if (!hub_.options.tokens.any() && !is_loopback_host(host))
      return refuse(http::status::misdirected_request, "this server is loopback's alone");
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return refuse(http::status::method_not_allowed, "GET and HEAD alone");
    const auto target = parse_target(view_of(request.target()));
    if (!target) return refuse(http::status::not_found, "no such page");
    const std::string presented =
        target->token.empty() ? cookie_value(view_of(request[http::field::cookie]), cookie_name)
                              : target->token;
    const Access access = access_of(hub_.options.tokens, presented, Access::control);
    if (access == Access::none)
      return refuse(http::status::unauthorized, "open the address with its token: /?token=...");
    if (std::holds_alternative<LiveRequest>(target->path)) return become_viewer(request, access);
    if (!target->token.empty()) return keep_token(*target);
    if (const auto* frame = std::get_if<FrameRequest>(&target->path)) return send_frame(*frame);
    send_file(std::get<FileRequest>(target->path).path);
  }

  void become_viewer(const http::request<http::empty_body>& request, Access access) {
    if (!websocket::is_upgrade(request))
      return refuse(http::status::upgrade_required, "a WebSocket");
    if (!is_own_origin(view_of(request[http::field::origin]), view_of(request[http::field::host])))
      return refuse(http::status::forbidden, "a page of another site");
    if (access == Access::control && !hub_.options.may_control) access = Access::view;
    std::make_shared<Viewer>(hub_, std::move(stream_), access)->accept(request);
  }

  /// The token moves from the address, which is seen and remembered, to a cookie.
  void keep_token(const RequestTarget& target) {
    Answer answer = begin(http::status::see_other);
    answer.set(http::field::location, "/");
    answer.set(http::field::set_cookie, std::string(cookie_name) + "=" + target.token +
                                            "; Path=/; HttpOnly; SameSite=Strict");
    send(std::move(answer));
  }

  void send_frame(const FrameRequest& request) {
    auto png = hub_.content.previews.preview(request.sensor, request.frame);
    if (!png) return refuse(http::status::not_found, "no preview of this frame");
    Answer answer = begin(http::status::ok);
    answer.set(http::field::content_type, "image/png");
    answer.set(http::field::cache_control, "private, max-age=3600");
    answer.body() = std::move(*png);
    send(std::move(answer));
  }

  void send_file(const std::string& path) {
    if (hub_.content.files.empty() && path == "index.html") {
      Answer answer = begin(http::status::ok);
      answer.set(http::field::content_type, "text/html; charset=utf-8");
      answer.set(http::field::cache_control, "no-store");
      answer.body() = no_dashboard;
      return send(std::move(answer));
    }
    const auto file = hub_.content.files.find(path);
    if (!file) return refuse(http::status::not_found, "no such page");
    const bool same = view_of(parser_->get()[http::field::if_none_match]) == file->etag;
    Answer answer = begin(same ? http::status::not_modified : http::status::ok);
    answer.set(http::field::content_type, file->type);
    answer.set(http::field::etag, file->etag);
    answer.set(http::field::cache_control, "no-cache");  // ask each time whether it changed
    if (!same) answer.body() = file->content;
    send(std::move(answer));
  }

  void refuse(http::status status, const char* reason) {
    Answer answer = begin(status);
    answer.set(http::field::content_type, "text/plain; charset=utf-8");
    answer.body() = std::string(reason) + "\n";
    answer.keep_alive(false);
    send(std::move(answer));
  }

  Answer begin(http::status status) {
    Answer answer{status, 11};
    answer.keep_alive(parser_->get().keep_alive());
    answer.set("Content-Security-Policy", content_policy);
    answer.set("X-Content-Type-Options", "nosniff");
    answer.set("Referrer-Policy", "no-referrer");
    answer.set("Cross-Origin-Resource-Policy", "same-origin");
    answer.set("Cross-Origin-Opener-Policy", "same-origin");
    return answer;
  }

  void send(Answer answer) {
    answer.prepare_payload();
    if (parser_->get().method() == http::verb::head) answer.body().clear();
    answer_ = std::move(answer);
    stream_.expires_after(milliseconds_of(hub_.options.request_within_s));
    http::async_write(stream_, answer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return;
      if (self->answer_.keep_alive()) return self->read();
      error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  Hub& hub_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{2 * max_head_bytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  Answer answer_;
};

}  // namespace

struct WebServer::Work {
  Work(WebServerOptions options, WebContent content)
      : hub{std::move(options), std::move(content), {}}, acceptor(io) {
    error_code error;
    const auto address = boost::asio::ip::make_address(hub.options.host, error);
    const std::string where = hub.options.host + ":" + std::to_string(hub.options.port);
    if (error) throw ConfigError(where + ": must be an IP address and a port");
    if (!address.is_loopback() && !hub.options.tokens.any())
      throw ConfigError(where + ": others could watch: needs a file of tokens, or loopback");
    const tcp::endpoint endpoint(address, hub.options.port);
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(128, error);
    if (error) throw Error(where + ": " + error.message());
    port = acceptor.local_endpoint().port();
    accept();
    thread = std::thread([this] { io.run(); });
  }

  ~Work() {
    io.stop();
    thread.join();
  }

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error == boost::asio::error::operation_aborted) return;
      if (error) {  // no file descriptor is free, say
        retry.expires_after(std::chrono::milliseconds(100));
        return retry.async_wait([this](error_code) { accept(); });
      }
      if (hub.connections.size() < hub.options.most_connections) {
        error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        socket.set_option(boost::asio::socket_base::send_buffer_size(send_buffer_bytes), ignored);
        std::make_shared<Visitor>(hub, std::move(socket))->read();
      }  // else it is closed
      accept();
    });
  }

  Hub hub;  // outlives the connections, which end with `io`
  boost::asio::io_context io{1};
  tcp::acceptor acceptor;
  boost::asio::steady_timer retry{io};
  int port = 0;
  std::thread thread;
};

WebServer::WebServer(WebServerOptions options, WebContent content)
    : work_(std::make_unique<Work>(std::move(options), std::move(content))) {}

WebServer::~WebServer() = default;

int WebServer::port() const { return work_->port; }

void WebServer::changed() {
  boost::asio::post(work_->io, [this] {
    for (Connection* connection : work_->hub.connections) connection->pump();
  });
}

}  // namespace dmise
