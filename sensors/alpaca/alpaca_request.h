#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/error.h"

// Requests of the ASCOM Alpaca API, version 1: functions of their text, which may be hostile.
namespace dmise {

/// A request that is none of the API: it is answered by a status of HTTP, 400 or 404.
class BadRequest : public Error {
 public:
  explicit BadRequest(const std::string& reason, int status = 400)
      : Error(reason), status_(status) {}
  int status() const { return status_; }

 private:
  int status_;
};

/// Parameters of a call. Their names are in lower case, for case does not matter.
class AlpacaParameters {
 public:
  /// Parses "Name=value&..."; in a form + is a space. The last counts if a name comes twice.
  static AlpacaParameters parse(std::string_view text);

  // A parameter; throw `BadRequest` for one that is missing or not of its kind. `name` is given in
  // the case of the API.
  std::string text(std::string_view name) const;
  double number(std::string_view name) const;  // finite
  std::int32_t integer(std::string_view name) const;
  bool flag(std::string_view name) const;
  /// A number of the client, 0 without it.
  std::uint32_t id(std::string_view name) const;

 private:
  const std::string* find(std::string_view name) const;
  std::map<std::string, std::string> values_;
};

/// `/api/v1/TYPE/NUMBER/MEMBER`.
struct DeviceCall {
  std::string type;  // telescope, camera
  std::uint32_t number = 0;
  std::string member;
  bool put = false;  // else it is read
};
struct ApiVersionsCall {};        // `/management/apiversions`
struct DescriptionCall {};        // `/management/v1/description`
struct ConfiguredDevicesCall {};  // `/management/v1/configureddevices`
struct SetupCall {};              // `/setup` and the pages of devices

struct AlpacaCall {
  std::variant<DeviceCall, ApiVersionsCall, DescriptionCall, ConfiguredDevicesCall, SetupCall> what;
  AlpacaParameters parameters;
  std::uint32_t client_transaction = 0;
  std::string token;  // access token in the query
};

inline constexpr std::size_t max_alpaca_target_bytes = 4096, max_alpaca_body_bytes = 8192;

/// Parses a request: GET, or PUT with a form as its body. Throws `BadRequest`.
AlpacaCall parse_alpaca(bool put, std::string_view target, std::string_view body);

}  // namespace dmise
