#include <boost/beast/websocket/rfc6455.hpp>

#include "nodes/gateway/connection.h"
#include "nodes/web/http_connection.h"

namespace dmise {
namespace {

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
class PageConnection : public HttpConnection<http::empty_body> {
 public:
  PageConnection(Hub& hub, tcp::socket socket)
      : HttpConnection(hub.connections, std::move(socket),
                       {.tokens = hub.options.tokens,
                        .request_within_s = hub.options.request_within_s,
                        .idle_s = hub.options.request_within_s,
                        .headers = {{"Content-Security-Policy", content_policy},
                                    {"X-Content-Type-Options", "nosniff"},
                                    {"Referrer-Policy", "no-referrer"},
                                    {"Cross-Origin-Resource-Policy", "same-origin"},
                                    {"Cross-Origin-Opener-Policy", "same-origin"}}}),
        hub_(hub) {}

 private:
  void answer(const Request& request) override {
    const std::string_view host = field(http::field::host);
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return refuse(http::status::method_not_allowed, "only GET and HEAD");
    const auto target = parse_target(view_of(request.target()));
    if (!target) return refuse(http::status::not_found, "no such page");
    const std::string presented = target->token.empty()
                                      ? cookie_value(field(http::field::cookie), cookie_name(host))
                                      : target->token;
    const Access access = let_in(presented);
    if (access == Access::none)
      return refuse(http::status::unauthorized, "open the address with its token: /?token=...");
    if (std::holds_alternative<LiveRequest>(target->path)) return become_viewer(request, access);
    if (!target->token.empty()) return keep_token(view_of(request.target()), host, target->token);
    if (const auto* frame = std::get_if<FrameRequest>(&target->path)) return send_frame(*frame);
    send_file(std::get<FileRequest>(target->path).path);
  }

  void become_viewer(const Request& request, Access access) {
    if (!beast::websocket::is_upgrade(request))
      return refuse(http::status::upgrade_required, "this is a WebSocket");
    if (!is_own_origin(field(http::field::origin), field(http::field::host)))
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
    hub_.waiting[ticket] = [this, self = shared_from_this()](const SharedPreview& png) {
      send_preview(png);
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
    HttpAnswer answer = begin(http::status::ok, "image/png");
    answer.set(http::field::cache_control, "private, max-age=3600");
    answer.body() = *png;
    send(std::move(answer));
  }

  void send_file(const std::string& path) {
    if (hub_.content.files.empty() && path == "index.html") {
      HttpAnswer answer = begin(http::status::ok, "text/html; charset=utf-8");
      answer.set(http::field::cache_control, "no-store");
      answer.body() = no_dashboard;
      return send(std::move(answer));
    }
    const auto file = hub_.content.files.find(path);
    if (!file) return refuse(http::status::not_found, "no such page");
    const bool gzip = takes_gzip(field(http::field::accept_encoding)) && !file->gzipped().empty();
    const std::string& etag = gzip ? file->gzipped_etag : file->etag;
    const bool same = field(http::field::if_none_match) == etag;
    HttpAnswer answer = begin(same ? http::status::not_modified : http::status::ok);
    answer.set(http::field::content_type, file->type);
    answer.set(http::field::etag, etag);
    answer.set(http::field::cache_control, "no-cache");  // ask each time whether it changed
    answer.set(http::field::vary, "Accept-Encoding");
    if (gzip) answer.set(http::field::content_encoding, "gzip");
    if (!same) answer.body() = gzip ? file->gzipped() : file->content;
    send(std::move(answer));
  }

  Hub& hub_;
};

}  // namespace

void serve_http(Hub& hub, tcp::socket socket) {
  std::make_shared<PageConnection>(hub, std::move(socket))->read();
}

}  // namespace dmise
