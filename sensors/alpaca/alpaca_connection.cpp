#include "sensors/alpaca/alpaca_connection.h"

#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <optional>

#include "core/base/printable.h"
#include "nodes/web/http_answer.h"

namespace dmise {
namespace {

using Steady = std::chrono::steady_clock;

constexpr std::size_t max_head_bytes = 8192;
constexpr const char* json_type = "application/json; charset=utf-8";
constexpr auto between_looks = std::chrono::milliseconds(20);  // at a slew

class AlpacaConnection : public Connection, public std::enable_shared_from_this<AlpacaConnection> {
 public:
  AlpacaConnection(AlpacaHub& hub, tcp::socket socket)
      : hub_(hub), stream_(std::move(socket)), timer_(stream_.get_executor()) {
    error_code ignored;
    address_ = stream_.socket().remote_endpoint(ignored).address().to_string();
    hub_.connections.add(this);
  }
  ~AlpacaConnection() override { hub_.connections.remove(this); }

  std::string stranger() const override { return has_access_ ? "" : address_; }
  void close() override { stream_.close(); }

  /// Goes on with `then` when something was read or written.
  template <class Then>
  auto when_read(Then then) {
    return [self = shared_from_this(), then = std::move(then)](error_code error, std::size_t) {
      if (!error) return then();
      if (error == http::error::body_limit || error == http::error::header_limit)
        self->refuse(http::status::payload_too_large, "the request is too long");
    };
  }

  void read() {
    parser_.emplace();
    parser_->header_limit(max_head_bytes);
    parser_->body_limit(max_alpaca_body_bytes);
    stream_.expires_after(
        milliseconds_of(has_access_ ? hub_.options.idle_s : hub_.options.request_within_s));
    http::async_read_header(stream_, buffer_, *parser_, when_read([this] { read_body(); }));
  }

 private:
  using Request = http::request<http::string_body>;
  /// Clients of .NET wait until they hear that the body of a PUT is wanted.
  void read_body() {
    if (!beast::iequals(parser_->get()[http::field::expect], "100-continue")) return read_rest();
    static constexpr std::string_view go_on = "HTTP/1.1 100 Continue\r\n\r\n";
    boost::asio::async_write(stream_, boost::asio::buffer(go_on),
                             when_read([this] { read_rest(); }));
  }

  void read_rest() {
    http::async_read(stream_, buffer_, *parser_, when_read([this] { take(); }));
  }

  void take() {
    const Request& request = parser_->get();
    const std::string_view host = view_of(request[http::field::host]);
    // A foreign page could resolve any other name to this machine (DNS rebinding).
    if (!hub_.options.tokens.any() && !is_loopback_host(host))
      return refuse(http::status::misdirected_request,
                    "this server answers requests for localhost only");
    if (!is_own_origin(view_of(request[http::field::origin]), host))
      return refuse(http::status::forbidden, "a page of another site may not use this server");
    const bool put = request.method() == http::verb::put;
    if (!put && request.method() != http::verb::get)
      return refuse(http::status::method_not_allowed, "only GET and PUT");
    try {
      answer(parse_alpaca(put, view_of(request.target()), request.body()), put);
    } catch (const BadRequest& error) {
      refuse(http::status(error.status()), error.what());
    }
  }

  void answer(const AlpacaCall& call, bool put) {
    const std::string given =
        authorization_token(view_of(parser_->get()[http::field::authorization]));
    const Access access = access_of(hub_.options.tokens, given.empty() ? call.token : given);
    if (access == Access::none)
      return refuse(http::status::unauthorized, "needs a token as the password");
    has_access_ = true;
    if (put && access != Access::control)
      return refuse(http::status::forbidden, "only the operator's token changes something");
    transaction_ = {call.client_transaction, ++hub_.transactions};
    if (const auto* device = std::get_if<DeviceCall>(&call.what))
      return answer_device(*device, call.parameters);
    if (std::holds_alternative<SetupCall>(call.what))
      return send("text/html; charset=utf-8", setup_page(hub_));
    send(json_type,
         json_answer(transaction_, std::holds_alternative<ApiVersionsCall>(call.what) ? "[1]"
                                   : std::holds_alternative<DescriptionCall>(call.what)
                                       ? description_json(hub_)
                                       : configured_devices_json(hub_)));
  }

  void answer_device(const DeviceCall& device, const AlpacaParameters& parameters) {
    guarded([&] {
      MemberAnswer answer = hub_.devices.call(device, parameters);
      if (answer.image) return send_image(*answer.image);
      waits_for_ = std::move(answer.done);
      if (!waits_for_) return send(json_type, json_answer(transaction_, answer.value));
      patience_ = Steady::now() + milliseconds_of(hub_.options.slew_within_s);
      stream_.expires_never();
      look();
    });
  }

  /// Sends what a device refuses as the API does.
  template <class Work>
  void guarded(const Work& work) {
    try {
      work();
    } catch (const BadRequest&) {
      throw;
    } catch (const DeviceError& error) {
      send(json_type, json_error(transaction_, int(error.fault()), printable(error.what(), 1000)));
    } catch (const Error& error) {
      send(json_type,
           json_error(transaction_, int(DeviceFault::driver), printable(error.what(), 1000)));
    }
  }

  /// Answers once what the answer waits for is true.
  void look() {
    if (waits_for_() || Steady::now() > patience_)
      return send(json_type, json_answer(transaction_, ""));
    timer_.expires_after(between_looks);
    timer_.async_wait([self = shared_from_this()](error_code error) {
      if (!error) self->guarded([&] { self->look(); });
    });
  }

  void send_image(const CountImage& image) {
    const bool bytes =
        view_of(parser_->get()[http::field::accept]).find("application/imagebytes") !=
        std::string_view::npos;
    if (bytes) return send("application/imagebytes", image_bytes(transaction_, image));
    send(json_type, json_image(transaction_, image));
  }

  void refuse(http::status status, const std::string& reason) {
    HttpAnswer answer = begin(status, "text/plain; charset=utf-8");
    if (status == http::status::unauthorized)
      answer.set(http::field::www_authenticate, "Basic realm=\"DMISE observatory\"");
    answer.body() = printable(reason, 1000) + "\n";
    answer.keep_alive(false);
    send(std::move(answer));
  }

  HttpAnswer begin(http::status status, const char* type) {
    HttpAnswer answer{status, 11};
    answer.keep_alive(parser_->is_done() && parser_->get().keep_alive());
    answer.set(http::field::content_type, type);
    answer.set("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
    answer.set("X-Content-Type-Options", "nosniff");
    answer.set(http::field::cache_control, "no-store");
    return answer;
  }

  void send(const char* type, std::string body) {
    HttpAnswer answer = begin(http::status::ok, type);
    answer.body() = std::move(body);
    send(std::move(answer));
  }

  void send(HttpAnswer answer) {
    answer.prepare_payload();
    sender_.send(std::move(answer), [self = shared_from_this()] { self->read(); });
  }

  AlpacaHub& hub_;
  beast::tcp_stream stream_;
  boost::asio::steady_timer timer_;
  beast::flat_buffer buffer_{2 * max_head_bytes + max_alpaca_body_bytes};
  std::optional<http::request_parser<http::string_body>> parser_;
  AnswerSender sender_{stream_, hub_.options.request_within_s};
  std::string address_;  // where the client is
  bool has_access_ = false;
  Transaction transaction_;
  std::function<bool()> waits_for_;
  Steady::time_point patience_;
};

}  // namespace

void serve_alpaca(AlpacaHub& hub, tcp::socket socket) {
  std::make_shared<AlpacaConnection>(hub, std::move(socket))->read();
}

}  // namespace dmise
