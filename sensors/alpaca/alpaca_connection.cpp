#include "sensors/alpaca/alpaca_connection.h"

#include <boost/asio/steady_timer.hpp>

#include "core/base/printable.h"
#include "nodes/web/http_connection.h"

namespace dmise {
namespace {

using Steady = std::chrono::steady_clock;

constexpr const char* json_type = "application/json; charset=utf-8";
constexpr auto between_looks = std::chrono::milliseconds(20);  // at a slew

class AlpacaConnection : public HttpConnection<http::string_body> {
 public:
  AlpacaConnection(AlpacaHub& hub, tcp::socket socket)
      : HttpConnection(
            hub.connections, std::move(socket),
            {.tokens = hub.options.tokens,
             .request_within_s = hub.options.request_within_s,
             .idle_s = hub.options.idle_s,
             .max_body_bytes = max_alpaca_body_bytes,
             .headers = {{"Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'"},
                         {"X-Content-Type-Options", "nosniff"},
                         {"Cache-Control", "no-store"}}}),
        hub_(hub),
        timer_(stream_.get_executor()) {}

 private:
  void answer(const Request& request) override {
    if (!is_own_origin(field(http::field::origin), field(http::field::host)))
      return refuse(http::status::forbidden, "a page of another site may not use this server");
    const bool put = request.method() == http::verb::put;
    if (!put && request.method() != http::verb::get)
      return refuse(http::status::method_not_allowed, "only GET and PUT");
    try {
      answer_call(parse_alpaca(put, view_of(request.target()), request.body()), put);
    } catch (const BadRequest& error) {
      refuse(http::status(error.status()), error.what());
    }
  }

  void answer_call(const AlpacaCall& call, bool put) {
    const std::string given = authorization_token(field(http::field::authorization));
    const Access access = let_in(given.empty() ? call.token : given);
    if (access == Access::none)
      return refuse(http::status::unauthorized, "needs a token as the password",
                    "Basic realm=\"DMISE observatory\"");
    if (put && access != Access::control)
      return refuse(http::status::forbidden, "only the operator's token changes something");
    transaction_ = {call.client_transaction, ++hub_.transactions};
    if (const auto* device = std::get_if<DeviceCall>(&call.what))
      return answer_device(*device, call.parameters);
    if (std::holds_alternative<SetupCall>(call.what))
      return send_text("text/html; charset=utf-8", setup_page(hub_));
    send_text(json_type,
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
      if (!waits_for_) return send_text(json_type, json_answer(transaction_, answer.value));
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
      send_text(json_type,
                json_error(transaction_, int(error.fault()), printable(error.what(), 1000)));
    } catch (const Error& error) {
      send_text(json_type,
                json_error(transaction_, int(DeviceFault::driver), printable(error.what(), 1000)));
    }
  }

  /// Answers once what the answer waits for is true.
  void look() {
    if (waits_for_() || Steady::now() > patience_)
      return send_text(json_type, json_answer(transaction_, ""));
    timer_.expires_after(between_looks);
    timer_.async_wait([this, self = shared_from_this()](error_code error) {
      if (!error) guarded([this] { look(); });
    });
  }

  void send_image(const CountImage& image) {
    const bool bytes =
        field(http::field::accept).find("application/imagebytes") != std::string_view::npos;
    if (bytes) return send_text("application/imagebytes", image_bytes(transaction_, image));
    send_text(json_type, json_image(transaction_, image));
  }

  void send_text(const char* type, std::string body) {
    HttpAnswer answer = begin(http::status::ok, type);
    answer.body() = std::move(body);
    send(std::move(answer));
  }

  AlpacaHub& hub_;
  boost::asio::steady_timer timer_;
  Transaction transaction_;
  std::function<bool()> waits_for_;
  Steady::time_point patience_;
};

}  // namespace

void serve_alpaca(AlpacaHub& hub, tcp::socket socket) {
  std::make_shared<AlpacaConnection>(hub, std::move(socket))->read();
}

}  // namespace dmise
