#include "nodes/web/access.h"

#include <sodium.h>
#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/base/nearest_name.h"

namespace dmise {
namespace {

constexpr std::size_t shortest_token = 16, longest_token = 128;

bool is_token(std::string_view text) {
  return text.size() >= shortest_token && text.size() <= longest_token &&
         std::ranges::all_of(text, is_word);
}

/// Compares digests of the texts, so that the time reveals nothing about either.
bool same_token(std::string_view a, std::string_view b) {
  unsigned char left[crypto_generichash_BYTES], right[crypto_generichash_BYTES];
  const auto digest = [](std::string_view text, unsigned char* out) {
    crypto_generichash(out, crypto_generichash_BYTES,
                       reinterpret_cast<const unsigned char*>(text.data()), text.size(), nullptr,
                       0);
  };
  digest(a, left);
  digest(b, right);
  return sodium_memcmp(left, right, sizeof left) == 0;
}

std::string_view without_port(std::string_view host) {
  const auto colon = host.rfind(':');
  if (colon == std::string_view::npos || host.ends_with(']')) return host;
  return host.substr(0, colon);
}

}  // namespace

bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

std::optional<std::string> unescape(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '%') {
      unsigned value = 0;
      if (i + 3 > text.size()) return std::nullopt;
      const auto read = std::from_chars(text.data() + i + 1, text.data() + i + 3, value, 16);
      if (read.ec != std::errc{} || read.ptr != text.data() + i + 3) return std::nullopt;
      c = char(value);
      i += 2;
    }
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return std::nullopt;
    plain += c;
  }
  return plain;
}

std::string_view take_part(std::string_view& list, char separator) {
  const auto end = std::min(list.find(separator), list.size());
  const std::string_view part = list.substr(0, end);
  list.remove_prefix(std::min(end + 1, list.size()));
  return part;
}

AccessTokens read_access_tokens(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0 && (status.st_mode & 077) != 0)
    throw ConfigError(path + ": others may read it; chmod 600");
  AccessTokens tokens;
  std::istringstream lines(read_text_file(path, 4096));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line.substr(0, line.find('#')));
    std::string kind, token, more;
    if (!(words >> kind)) continue;
    const std::string place = path + ":" + std::to_string(number) + ": ";
    if (kind != "view" && kind != "truth" && kind != "operator")
      throw ConfigError(place + "must be view, truth or operator TOKEN" +
                        did_you_mean(kind, {"view", "truth", "operator"}) + ", got " + kind);
    if (!(words >> token) || words >> more || !is_token(token))
      throw ConfigError(place + kind + ": needs a token of 16 to 128 letters, digits, - or _");
    std::string& place_of = kind == "view"    ? tokens.view
                            : kind == "truth" ? tokens.truth
                                              : tokens.control;
    if (!place_of.empty()) throw ConfigError(place + kind + ": given twice");
    place_of = token;
  }
  if (!tokens.any()) throw ConfigError(path + ": has no token");
  const auto same = [](const std::string& a, const std::string& b) { return !a.empty() && a == b; };
  if (same(tokens.view, tokens.truth) || same(tokens.view, tokens.control) ||
      same(tokens.truth, tokens.control))
    throw ConfigError(path + ": the tokens must differ");
  return tokens;
}

Access access_of(const AccessTokens& tokens, std::string_view presented) {
  if (!tokens.any()) return Access::control;
  // All are always compared. An unset token is equal to nothing that is_token lets through.
  const bool is_control = same_token(tokens.control, presented) && !tokens.control.empty();
  const bool is_view = same_token(tokens.view, presented) && !tokens.view.empty();
  const bool is_truth = same_token(tokens.truth, presented) && !tokens.truth.empty();
  return is_control ? Access::control
         : is_truth ? Access::truth
         : is_view  ? Access::view
                    : Access::none;
}

bool is_loopback_host(std::string_view host) {
  const std::string_view name = without_port(host);
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]";
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  if (origin.empty()) return true;
  for (const std::string_view scheme : {"http://", "https://"})
    if (origin.starts_with(scheme) && origin.substr(scheme.size()) == host) return !host.empty();
  return false;
}

std::string cookie_name(std::string_view host) {
  const std::string_view port = host.substr(std::min(without_port(host).size() + 1, host.size()));
  const bool is_number = !port.empty() && port.size() <= 5 &&
                         port.find_first_not_of("0123456789") == std::string_view::npos;
  return is_number ? "dmise_token_" + std::string(port) : "dmise_token";
}

std::string cookie_value(std::string_view cookies, std::string_view name) {
  while (!cookies.empty()) {
    const std::string_view part = trimmed(take_part(cookies, ';'));
    if (part.starts_with(name) && part.substr(name.size()).starts_with('=')) {
      const std::string_view value = part.substr(name.size() + 1);
      return is_token(value) ? std::string(value) : std::string();
    }
  }
  return {};
}

std::string query_token(std::string_view query) {
  while (!query.empty())
    if (const auto part = take_part(query, '&');
        part.starts_with(token_key) && is_token(part.substr(token_key.size())))
      return std::string(part.substr(token_key.size()));
  return {};
}

std::string authorization_token(std::string_view authorization) {
  std::string_view rest = trimmed(authorization);
  const std::string_view scheme = take_part(rest, ' ');
  rest = trimmed(rest);
  if (scheme == "Bearer") return is_token(rest) ? std::string(rest) : std::string();
  if (scheme != "Basic" || rest.size() > 512) return {};
  std::string plain(rest.size(), '\0');
  std::size_t size = 0;
  if (sodium_base642bin(reinterpret_cast<unsigned char*>(plain.data()), plain.size(), rest.data(),
                        rest.size(), nullptr, &size, nullptr, sodium_base64_VARIANT_ORIGINAL) != 0)
    return {};
  plain.resize(size);
  const std::size_t colon = std::min(plain.find(':'), plain.size());
  const std::string_view password =
      std::string_view(plain).substr(std::min(colon + 1, plain.size()));
  return is_token(password) ? std::string(password) : std::string();
}

}  // namespace dmise
