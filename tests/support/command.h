#pragma once
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

namespace dmise::test {

/// Exit status and output of a shell command.
inline std::pair<int, std::string> command_output(const std::string& command) {
  std::string output;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) return {-1, ""};
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) output.append(buffer, n);
  return {pclose(pipe), output};
}

/// A Python that has a module of launch/setup/python-packages.txt; empty if there is none.
inline std::string python_with(const std::string& module) {
  const char* named = std::getenv("DMISE_PYTHON");
  for (const std::string& python :
       {std::string(named ? named : ""), std::string(DMISE_SOURCE_DIR "/build/venv/bin/python"),
        std::string("/usr/bin/python3")})
    if (!python.empty() &&
        std::system((python + " -c 'import " + module + "' 2> /dev/null").c_str()) == 0)
      return python;
  return "";
}

}  // namespace dmise::test
