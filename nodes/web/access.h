#pragma once
#include <optional>
#include <string>
#include <string_view>

// Who may do what with a server: functions of the text of a request, which may be hostile.
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

/// Name of the cookie with the token of the server `host`, the value of a Host header. Servers on
/// other ports of a host have others, for browsers send cookies to all of its ports.
std::string cookie_name(std::string_view host);

/// Returns the value of `name` in a Cookie header, a token; "" if there is none.
std::string cookie_value(std::string_view cookies, std::string_view name);

/// Returns the token of a query "a=b&token=TOKEN"; "" if there is none.
std::string query_token(std::string_view query);

/// Returns the password of an Authorization header of the scheme Basic, or the token of one of the
/// scheme Bearer; "" if that is not a token.
std::string authorization_token(std::string_view authorization);

/// Begins the part of a query that is a token.
inline constexpr std::string_view token_key = "token=";

/// Decodes "%41"; empty for an incomplete escape or a control character.
std::optional<std::string> unescape(std::string_view text);

/// Removes and returns the part of a list before the next separator.
std::string_view take_part(std::string_view& list, char separator);

/// Whether `c` is a letter, digit, - or _.
bool is_word(char c);

}  // namespace dmise
