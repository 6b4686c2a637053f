#include <boost/beast/websocket/rfc6455.hpp>

#include "nodes/gateway/connection.h"
#include "nodes/web/http_answer.h"

namespace dmise {
namespace {

constexpr std::size_t max_head_bytes = 8192;

// Pages load nothing from other servers. Cesium compiles WebAssembly and starts its workers from
// blobs; scripts set styles of elements.
constexpr const char* content_policy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval' blob:; worker-src 'self' blob:; "
    "style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self'; "
    "connect-src 'self' ws: wss:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

constexpr const char* no_dashboard =
    "<!doctype html><html lang='en'><meta charset='utf-8'><title>DMISE live view</title>"
    "<h1>The dashboard is not built</h1><p>The gateway runs, and has no pages to show. "
    "<code>./dmise dashboard</code> builds them: it needs npm.</p></html>";

/// A connection that speaks HTTP, until it becomes a WebSocket.
class HttpConnection : public Connection, public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Hub& hub, tcp::socket socket) : hub_(hub), stream_(std::move(socket)) {
    error_code ignored;
    address_ = stream_.socket().remote_endpoint(ignored).address().to_string();
    hub_.connections.add(this);
  }
  ~HttpConnection() override { hub_.connections.remove(this); }

  std::string stranger() const override { return has_access_ ? "" : address_; }
  void close() override { stream_.close(); }

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
  void take() {
    const auto& request = parser_->get();
    const std::string_view host = view_of(request[http::field::host]);
    // A foreign page could resolve any other name to this machine (DNS rebinding).
    if (!hub_.options.tokens.any() && !is_loopback_host(host))
      return refuse(http::status::misdirected_request,
                    "this server answers requests for localhost only");
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return refuse(http::status::method_not_allowed, "only GET and HEAD");
    const auto target = parse_target(view_of(request.target()));
    if (!target) return refuse(http::status::not_found, "no such page");
    const std::string presented =
        target->token.empty()
            ? cookie_value(view_of(request[http::field::cookie]), cookie_name(host))
            : target->token;
    const Access access = access_of(hub_.options.tokens, presented);
    if (access == Access::none)
      return refuse(http::status::unauthorized, "open the address with its token: /?token=...");
    has_access_ = true;
    if (std::holds_alternative<LiveRequest>(target->path)) return become_viewer(request, access);
    if (!target->token.empty()) return keep_token(view_of(request.target()), host, target->token);
    if (const auto* frame = std::get_if<FrameRequest>(&target->path)) return send_frame(*frame);
    send_file(std::get<FileRequest>(target->path).path);
  }

  void become_viewer(const http::request<http::empty_body>& request, Access access) {
    if (!beast::websocket::is_upgrade(request))
      return refuse(http::status::upgrade_required, "this is a WebSocket");
    if (!is_own_origin(view_of(request[http::field::origin]), view_of(request[http::field::host])))
      return refuse(http::status::forbidden, "a page of another site may not connect");
    if (access == Access::control && !hub_.options.may_control) access = Access::truth;
    serve_viewer(hub_, std::move(stream_), request, access);
  }

  /// Moves the token from the address, which browsers show and store, to a cookie.
  void keep_token(std::string_view target, std::string_view host, const std::string& token) {
    HttpAnswer answer = begin(http::status::see_other);
    answer.set(http::field::location, without_token(target));
    answer.set(http::field::set_cookie,
               cookie_name(host) + "=" + token + "; Path=/; HttpOnly; SameSite=Strict");
    send(std::move(answer));
  }

  void send_frame(const FrameRequest& request) {
    const std::uint64_t ticket = ++hub_.last_ticket;
    hub_.waiting[ticket] = [self = shared_from_this()](const SharedPreview& png) {
      self->send_preview(png);
    };
    hub_.content.previews.request(request.sensor, request.frame,
                                  [thread = hub_.thread, hub = &hub_, ticket](SharedPreview png) {
                                    thread->post([hub, ticket, png = std::move(png)] {
                                      if (auto waited = hub->waiting.extract(ticket))
                                        waited.mapped()(png);
                                    });
                                  });
  }

  void send_preview(const SharedPreview& png) {
    if (!png) return refuse(http::status::not_found, "no preview of this frame");
    HttpAnswer answer = begin(http::status::ok);
    answer.set(http::field::content_type, "image/png");
    answer.set(http::field::cache_control, "private, max-age=3600");
    answer.body() = *png;
    send(std::move(answer));
  }

  void send_file(const std::string& path) {
    if (hub_.content.files.empty() && path == "index.html") {
      HttpAnswer answer = begin(http::status::ok);
      answer.set(http::field::content_type, "text/html; charset=utf-8");
      answer.set(http::field::cache_control, "no-store");
      answer.body() = no_dashboard;
      return send(std::move(answer));
    }
    const auto file = hub_.content.files.find(path);
    if (!file) return refuse(http::status::not_found, "no such page");
    const auto& request = parser_->get();
    const bool gzip =
        takes_gzip(view_of(request[http::field::accept_encoding])) && !file->gzipped().empty();
    const std::string& etag = gzip ? file->gzipped_etag : file->etag;
    const bool same = view_of(request[http::field::if_none_match]) == etag;
    HttpAnswer answer = begin(same ? http::status::not_modified : http::status::ok);
    answer.set(http::field::content_type, file->type);
    answer.set(http::field::etag, etag);
    answer.set(http::field::cache_control, "no-cache");  // ask each time whether it changed
    answer.set(http::field::vary, "Accept-Encoding");
    if (gzip) answer.set(http::field::content_encoding, "gzip");
    if (!same) answer.body() = gzip ? file->gzipped() : file->content;
    send(std::move(answer));
  }

  void refuse(http::status status, const char* reason) {
    HttpAnswer answer = begin(status);
    answer.set(http::field::content_type, "text/plain; charset=utf-8");
    answer.body() = std::string(reason) + "\n";
    answer.keep_alive(false);
    send(std::move(answer));
  }

  HttpAnswer begin(http::status status) {
    HttpAnswer answer{status, 11};
    answer.keep_alive(parser_->get().keep_alive());
    answer.set("Content-Security-Policy", content_policy);
    answer.set("X-Content-Type-Options", "nosniff");
    answer.set("Referrer-Policy", "no-referrer");
    answer.set("Cross-Origin-Resource-Policy", "same-origin");
    answer.set("Cross-Origin-Opener-Policy", "same-origin");
    return answer;
  }

  void send(HttpAnswer answer) {
    answer.prepare_payload();
    if (parser_->get().method() == http::verb::head) answer.body().clear();
    sender_.send(std::move(answer), [self = shared_from_this()] { self->read(); });
  }

  Hub& hub_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{2 * max_head_bytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  AnswerSender sender_{stream_, hub_.options.request_within_s};
  std::string address_;  // where the client is
  bool has_access_ = false;
};

}  // namespace

void serve_http(Hub& hub, tcp::socket socket) {
  std::make_shared<HttpConnection>(hub, std::move(socket))->read();
}

}  // namespace dmise
