#include "core/config/objects/object_names.h"

#include <map>

#include "core/base/files/text_fields.h"
#include "core/base/nearest_name.h"

namespace dmise {

std::string nearest_object(std::string_view word, const std::vector<std::string>& names) {
  std::vector<std::string> ways;               // spellings
  std::map<std::string, std::string> name_of;  // first name with that spelling
  const auto add = [&](std::string_view way, const std::string& name) {
    if (way.empty()) return;
    ways.push_back(upper_case(way));
    name_of.emplace(ways.back(), name);
  };
  for (const auto& name : names) {
    add(name, name);
    const auto open = name.find(" ("), close = name.rfind(')');
    if (open == std::string::npos || close == std::string::npos || close < open) continue;
    add(std::string_view(name).substr(0, open), name);
    add(std::string_view(name).substr(open + 2, close - open - 2), name);
  }
  const std::string nearest = nearest_name(upper_case(word), ways);
  return nearest.empty() ? "" : name_of.at(nearest);
}

}  // namespace dmise
