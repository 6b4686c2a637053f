#include "nodes/runtime/process/last_line.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

namespace dmise {

std::string last_line(const std::string& path) {
  std::ifstream file(path);
  std::string line, last;
  while (std::getline(file, line))
    if (!line.empty()) last = line;
  if (last.starts_with('{'))  // a log in JSON
    if (const auto event = nlohmann::json::parse(last, nullptr, false); event.is_object())
      return event.value("text", last);
  constexpr std::string_view before_message = " error: ";  // follows time, node and level
  const auto at = last.find(before_message);
  return at == std::string::npos ? last : last.substr(at + before_message.size());
}

}  // namespace dmise
