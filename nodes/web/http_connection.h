#pragma once
#include <boost/asio/write.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/printable.h"
#include "nodes/web/access.h"
#include "nodes/web/connection.h"

namespace dmise {

using HttpAnswer = http::response<http::string_body>;

/// What a server of HTTP asks of requests, and adds to each answer.
struct HttpRules {
  const AccessTokens& tokens;
  double request_within_s = 0.0;  // a request, and each piece of its answer
  double idle_s = 0.0;            // before the next request of a client that has access
  std::size_t max_body_bytes = 0;
  std::vector<std::pair<const char*, const char*>> headers;
};

/// Reads the requests of a client one after the other, and sends answers piece by piece: a client
/// has the time for each piece, not for the whole. Without tokens it answers this machine alone.
template <class Body>
class HttpConnection : public SocketConnection,
                       public std::enable_shared_from_this<HttpConnection<Body>> {
 public:
  using Request = http::request<Body>;

  void read() {
    parser_.emplace();
    parser_->header_limit(max_head_bytes);
    parser_->body_limit(rules_.max_body_bytes);
    stream_.expires_after(milliseconds_of(has_access_ ? rules_.idle_s : rules_.request_within_s));
    http::async_read_header(stream_, buffer_, *parser_, when_read([this] { read_body(); }));
  }

 protected:
  HttpConnection(Connections& all, tcp::socket socket, HttpRules rules)
      : SocketConnection(all, std::move(socket)),
        rules_(std::move(rules)),
        buffer_(2 * max_head_bytes + rules_.max_body_bytes) {}

  /// Answers a request of a page of this machine, or of anybody where there are tokens.
  virtual void answer(const Request& request) = 0;

  const Request& request() const { return parser_->get(); }
  std::string_view field(http::field name) const { return view_of(request()[name]); }
  /// Whether a token gives access; the client then keeps its place among others.
  Access let_in(std::string_view token) {
    const Access access = access_of(rules_.tokens, token);
    has_access_ = has_access_ || access != Access::none;
    return access;
  }

  HttpAnswer begin(http::status status, const char* type = nullptr) const {
    HttpAnswer answer{status, 11};
    answer.keep_alive(parser_->is_done() && request().keep_alive());
    if (type) answer.set(http::field::content_type, type);
    for (const auto& [name, value] : rules_.headers) answer.set(name, value);
    return answer;
  }

  void refuse(http::status status, const std::string& reason, const char* challenge = nullptr) {
    HttpAnswer answer = begin(status, "text/plain; charset=utf-8");
    if (challenge) answer.set(http::field::www_authenticate, challenge);
    answer.body() = printable(reason) + "\n";
    answer.keep_alive(false);
    send(std::move(answer));
  }

  /// Reads on when all is sent, if the connection is kept alive.
  void send(HttpAnswer answer) {
    answer.prepare_payload();
    if (request().method() == http::verb::head) answer.body().clear();
    answer_ = std::move(answer);
    rest_.emplace(answer_);
    write();
  }

 private:
  static constexpr std::size_t max_head_bytes = 8192;

  bool has_access() const override { return has_access_; }

  /// Goes on with `then` when something was read.
  template <class Then>
  auto when_read(Then then) {
    return [self = this->shared_from_this(), then](error_code error, std::size_t) {
      if (!error) return then();
      if (error == http::error::body_limit || error == http::error::header_limit)
        self->refuse(http::status::payload_too_large, "the request is too long");
    };
  }

  /// Clients of .NET wait until they hear that the body of a PUT is wanted.
  void read_body() {
    if (!beast::iequals(request()[http::field::expect], "100-continue")) return read_rest();
    static constexpr std::string_view go_on = "HTTP/1.1 100 Continue\r\n\r\n";
    boost::asio::async_write(stream_, boost::asio::buffer(go_on),
                             when_read([this] { read_rest(); }));
  }

  void read_rest() {
    http::async_read(stream_, buffer_, *parser_, when_read([this] { take(); }));
  }

  void take() {
    // A foreign page could resolve any other name to this machine (DNS rebinding).
    if (!rules_.tokens.any() && !is_loopback_host(field(http::field::host)))
      return refuse(http::status::misdirected_request,
                    "this server answers requests for localhost only");
    answer(request());
  }

  void write() {
    stream_.expires_after(milliseconds_of(rules_.request_within_s));
    http::async_write_some(stream_, *rest_,
                           [self = this->shared_from_this()](error_code error, std::size_t) {
                             if (error) return;
                             if (!self->rest_->is_done()) return self->write();
                             if (self->answer_.keep_alive()) return self->read();
                             error_code ignored;
                             self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                           });
  }

  HttpRules rules_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<Body>> parser_;
  HttpAnswer answer_;
  std::optional<http::response_serializer<http::string_body>> rest_;  // what is left of the answer
  bool has_access_ = false;
};

}  // namespace dmise
