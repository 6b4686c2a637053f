#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

// Which requests are answered: functions of the text of a request, which may be hostile.
namespace dmise {

/// What a viewer may do; each includes those before it.
enum class Access { none, view, truth, control };

/// Tokens that viewers present. All empty: every client on this machine has full access.
struct AccessTokens {
  std::string view, control, truth;  // empty: nobody gets this access by a token

  bool any() const { return !view.empty() || !truth.empty() || !control.empty(); }
};

/// Reads a file with lines `view TOKEN`, `truth TOKEN` and `operator TOKEN`, or some of them; each
/// token has at least 16 letters, digits, - or _. Throws `ConfigError`, also if others than its
/// owner may read the file.
AccessTokens read_access_tokens(const std::string& path);

/// Access of a presented token; full access if no tokens are set. Compares in constant time.
Access access_of(const AccessTokens& tokens, std::string_view presented);

/// Whether `host`, the value of a Host header, names this machine's loopback. A foreign site could
/// resolve another name to this machine (DNS rebinding).
bool is_loopback_host(std::string_view host);

/// Whether a page of `origin`, an Origin header, may open a WebSocket of the server `host`. An
/// empty origin, of clients that are not browsers, may.
bool is_own_origin(std::string_view origin, std::string_view host);

/// `/frames/SENSOR/NUMBER.png`; frames count from 1.
struct FrameRequest {
  std::string sensor;
  std::uint32_t frame = 0;

  bool operator==(const FrameRequest&) const = default;
};

struct LiveRequest {  // `/live`: the WebSocket
  bool operator==(const LiveRequest&) const = default;
};

/// A file of the dashboard.
struct FileRequest {
  std::string path;  // "index.html", "assets/x.js": no leading slash, no . or .. part

  bool operator==(const FileRequest&) const = default;
};

using RequestPath = std::variant<LiveRequest, FrameRequest, FileRequest>;

struct RequestTarget {
  RequestPath path;
  std::string token;  // of the query

  bool operator==(const RequestTarget&) const = default;
};

/// Parses the target of a request; empty if there is no such target.
std::optional<RequestTarget> parse_target(std::string_view target);

/// The target of a request whose target has a token, without it.
std::string without_token(std::string_view target);

/// Name of the cookie with the token of the server `host`, the value of a Host header. Servers on
/// other ports of a host have others, for browsers send cookies to all of its ports.
std::string cookie_name(std::string_view host);

/// Whether `encodings`, the value of an Accept-Encoding header, admits gzip.
bool takes_gzip(std::string_view encodings);

/// Returns the value of `name` in a Cookie header, a token; "" if there is none.
std::string cookie_value(std::string_view cookies, std::string_view name);

}  // namespace dmise
