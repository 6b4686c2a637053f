#include "nodes/runtime/process/process_stat.h"

#include <fstream>
#include <iterator>
#include <sstream>

namespace dmise {

std::vector<std::string> process_stat(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto name_end = text.rfind(')');  // the name may contain any character
  if (name_end == std::string::npos) return {};
  std::istringstream fields(text.substr(name_end + 1));
  return {std::istream_iterator<std::string>(fields), {}};
}

char process_state(pid_t pid) {
  const auto fields = process_stat(pid);
  return fields.empty() ? '?' : fields.front().front();
}

}  // namespace dmise
