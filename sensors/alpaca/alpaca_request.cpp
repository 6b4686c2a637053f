#include "sensors/alpaca/alpaca_request.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "core/base/printable.h"
#include "nodes/web/access.h"

namespace dmise {
namespace {

constexpr std::size_t max_parameters = 64;

std::string lower(std::string_view text) {
  std::string small(text);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return small;
}

template <class Number>
bool read_all(std::string_view text, Number& number) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  return read.ec == std::errc{} && read.ptr == text.data() + text.size();
}

[[noreturn]] void refuse(std::string_view name, const char* what, const std::string& got) {
  throw BadRequest(std::string(name) + ": must be " + what + ", got " + printable(got, 60));
}

/// A part of a form or a query; a + in it is a space.
std::string plain(std::string_view part) {
  std::string spaced(part);
  std::ranges::replace(spaced, '+', ' ');
  auto text = unescape(spaced);
  if (!text) throw BadRequest("a parameter has an escape that is none");
  return *std::move(text);
}

std::vector<std::string> parts_of(std::string_view path) {
  std::vector<std::string> parts;
  while (!path.empty()) parts.emplace_back(take_part(path, '/'));
  return parts;
}

bool is_setup(const std::vector<std::string>& p) {
  return p[0] == "setup" && (p.size() == 1 || (p.size() == 5 && p[1] == "v1" && p[4] == "setup"));
}

decltype(AlpacaCall::what) what_of(const std::vector<std::string>& p, bool put) {
  using Parts = std::vector<std::string>;
  if (p.empty() || (!put && is_setup(p))) return SetupCall{};
  if (!put && p == Parts{"management", "apiversions"}) return ApiVersionsCall{};
  if (!put && p == Parts{"management", "v1", "description"}) return DescriptionCall{};
  if (!put && p == Parts{"management", "v1", "configureddevices"}) return ConfiguredDevicesCall{};
  if (p[0] != "api") throw BadRequest("no such page", 404);
  if (p.size() != 5 || p[1] != "v1") throw BadRequest("must be /api/v1/TYPE/NUMBER/MEMBER");
  DeviceCall call{.type = p[2], .member = p[4], .put = put};
  if (!read_all(p[3], call.number)) refuse("device number", "a whole number", p[3]);
  return call;
}

}  // namespace

AlpacaParameters AlpacaParameters::parse(std::string_view text) {
  AlpacaParameters parameters;
  while (!text.empty()) {
    std::string_view value = take_part(text, '&');
    if (value.empty()) continue;
    const std::string name = lower(plain(take_part(value, '=')));
    parameters.values_[name] = plain(value);
    if (parameters.values_.size() > max_parameters) throw BadRequest("too many parameters");
  }
  return parameters;
}

const std::string* AlpacaParameters::find(std::string_view name) const {
  const auto found = values_.find(lower(name));
  return found == values_.end() ? nullptr : &found->second;
}

std::string AlpacaParameters::text(std::string_view name) const {
  const std::string* value = find(name);
  if (!value) throw BadRequest(std::string(name) + ": is missing");
  return *value;
}

double AlpacaParameters::number(std::string_view name) const {
  const std::string value = text(name);
  double number = 0.0;
  if (!read_all(value, number) || !std::isfinite(number)) refuse(name, "a number", value);
  return number;
}

std::int32_t AlpacaParameters::integer(std::string_view name) const {
  const std::string value = text(name);
  std::int32_t number = 0;
  if (!read_all(value, number)) refuse(name, "a whole number", value);
  return number;
}

bool AlpacaParameters::flag(std::string_view name) const {
  const std::string value = text(name), small = lower(value);
  if (small != "true" && small != "false") refuse(name, "true or false", value);
  return small == "true";
}

std::uint32_t AlpacaParameters::id(std::string_view name) const {
  const std::string* value = find(name);
  if (!value || value->empty()) return 0;
  std::uint32_t number = 0;
  if (!read_all(*value, number)) refuse(name, "0 to 4294967295", *value);
  return number;
}

AlpacaCall parse_alpaca(bool put, std::string_view target, std::string_view body) {
  if (target.empty() || target.front() != '/' || target.size() > max_alpaca_target_bytes ||
      body.size() > max_alpaca_body_bytes)
    throw BadRequest("the target must begin with / and be shorter");
  const auto mark = std::min(target.find('?'), target.size());
  const std::string_view query = target.substr(std::min(mark + 1, target.size()));
  std::string_view path = target.substr(1, mark - 1);
  if (path.ends_with('/')) path.remove_suffix(1);
  AlpacaCall call{.what = what_of(parts_of(path), put),
                  .parameters = AlpacaParameters::parse(put ? body : query),
                  .client_transaction = 0,
                  .token = query_token(query)};
  call.client_transaction = call.parameters.id("ClientTransactionID");
  call.parameters.id("ClientID");
  return call;
}

}  // namespace dmise
