#include "nodes/gateway/request_rules.h"

#include <algorithm>
#include <charconv>

#include "core/base/files/text_fields.h"

namespace dmise {
namespace {

constexpr std::size_t longest_target = 1024, longest_sensor = 128;

std::optional<FrameRequest> frame_of(std::string_view path) {
  constexpr std::string_view ending = ".png";
  const auto slash = path.find('/');
  if (slash == std::string_view::npos || !path.ends_with(ending)) return std::nullopt;
  const auto sensor = unescape(path.substr(0, slash));
  if (!sensor || sensor->empty() || sensor->size() > longest_sensor || sensor->front() == '.' ||
      sensor->find('/') != std::string::npos)
    return std::nullopt;
  const std::string_view digits = path.substr(slash + 1, path.size() - slash - 1 - ending.size());
  FrameRequest request{*sensor, 0};
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), request.frame);
  if (read.ec != std::errc{} || read.ptr != digits.data() + digits.size() || request.frame == 0)
    return std::nullopt;
  return request;
}

/// Whether `path` has parts of letters, digits, ., -, _ and @ that do not begin with a point.
bool is_file_path(std::string_view path) {
  char last = '/';
  for (const char c : path) {
    if (!is_word(c) && c != '.' && c != '/' && c != '@') return false;
    if (last == '/' && (c == '/' || c == '.')) return false;
    last = c;
  }
  return last != '/';
}

}  // namespace

std::optional<RequestTarget> parse_target(std::string_view target) {
  if (target.empty() || target.front() != '/' || target.size() > longest_target)
    return std::nullopt;
  const auto mark = std::min(target.find('?'), target.size());
  std::string_view path = target.substr(1, mark - 1);
  RequestTarget request;
  request.token = query_token(target.substr(std::min(mark + 1, target.size())));
  constexpr std::string_view frames = "frames/";
  if (path == "live") {
    request.path = LiveRequest{};
  } else if (path.starts_with(frames)) {
    const auto frame = frame_of(path.substr(frames.size()));
    if (!frame) return std::nullopt;
    request.path = *frame;
  } else {
    if (path.empty()) path = "index.html";
    if (!is_file_path(path)) return std::nullopt;
    request.path = FileRequest{std::string(path)};
  }
  return request;
}

std::string without_token(std::string_view target) {
  std::string rest(take_part(target, '?'));
  char before = '?';
  while (!target.empty()) {
    const auto part = take_part(target, '&');
    if (part.starts_with(token_key)) continue;
    rest += before;
    rest += part;
    before = '&';
  }
  return rest;
}

bool takes_gzip(std::string_view encodings) {
  while (!encodings.empty()) {
    std::string_view weight = take_part(encodings, ',');
    if (trimmed(take_part(weight, ';')) != "gzip") continue;
    weight = trimmed(weight);
    return !weight.starts_with("q=0") || weight.find_first_of("123456789") != weight.npos;
  }
  return false;
}

}  // namespace dmise
