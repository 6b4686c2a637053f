// What browsers and others send to the gateway: commands, targets, hosts, origins, cookies, tokens.
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "nodes/gateway/request_rules.h"
#include "nodes/gateway/viewer_command.h"

namespace {

using namespace dmise;

void require(bool holds) {
  if (!holds) __builtin_trap();
}

void check_command(std::string_view text) {
  const ViewerCommand command = parse_viewer_command(text);
  if (const auto* clock = std::get_if<ClockCommand>(&command)) {
    require(clock->action != ClockCommand::Action::step ||
            (clock->ticks >= 1 && clock->ticks <= max_step_ticks));
    require(clock->factor >= 0.0 && clock->factor <= max_pace_factor);
  }
  if (const auto* past = std::get_if<PastCommand>(&command)) require(std::isfinite(past->time_s));
}

void check_target(std::string_view text) {
  const auto target = parse_target(text);
  if (!target) return;
  if (const auto* file = std::get_if<FileRequest>(&target->path)) {
    require(!file->path.empty() && file->path.front() != '/');
    require(("/" + file->path).find("/.") == std::string::npos);
  }
  if (const auto* frame = std::get_if<FrameRequest>(&target->path)) {
    require(!frame->sensor.empty() && frame->sensor.front() != '.');
    require(frame->sensor.find('/') == std::string::npos);
    require(frame->sensor.find('\0') == std::string::npos);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string_view first = text.substr(0, text.find('\n'));
  const std::string_view rest = text.substr(std::min(first.size() + 1, text.size()));
  switch (data[0] % 5) {
    case 0:
      check_command(text);
      break;
    case 1:
      check_target(text);
      break;
    case 2:
      if (is_own_origin(first, rest) && !first.empty())
        require(!rest.empty() && first.ends_with(rest));
      break;
    case 3:
      if (is_loopback_host(text))
        require(text.starts_with("localhost") || text.starts_with("127.0.0.1") ||
                text.starts_with("[::1]"));
      break;
    default: {
      const AccessTokens tokens{"viewerviewerviewer", "operatoroperator", "truthtruthtruthtruth"};
      const std::string cookie = cookie_value(text, "dmise_token");
      const Access access = access_of(tokens, cookie);
      require((access == Access::view) == (cookie == tokens.view));
      require((access == Access::control) == (cookie == tokens.control));
    }
  }
  return 0;
}
