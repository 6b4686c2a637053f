#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "nodes/web/access.h"

// Which requests are answered: functions of the text of a request, which may be hostile.
namespace dmise {

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
  std::string token;  // access token in the query

  bool operator==(const RequestTarget&) const = default;
};

/// Parses the target of a request; empty if there is no such target.
std::optional<RequestTarget> parse_target(std::string_view target);

/// The target of a request whose target has a token, without it.
std::string without_token(std::string_view target);

/// Whether `encodings`, the value of an Accept-Encoding header, admits gzip.
bool takes_gzip(std::string_view encodings);

}  // namespace dmise
