#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

namespace dmise {
namespace {

namespace fs = std::filesystem;

/// A line of C++ without what stands in quotes and after `//`.
std::string code_of(const std::string& line) {
  std::string code;
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && (i == 0 || line[i - 1] != '\\')) quoted = !quoted;
    if (!quoted && line.compare(i, 2, "//") == 0) break;
    if (!quoted) code += line[i];
  }
  return code;
}

// A float holds a position in low orbit to 0.5 m.
TEST(Sources, NoSinglePrecisionWherePositionsAreComputed) {
  const std::regex single(R"(\bfloat\b|\b__m(128|256|512)\b|_ps\(|[0-9]\.[0-9]*f\b|\bstrtof\b|\bsqrtf\b)");
  int files = 0;
  for (const char* directory : {"core/time", "core/frames", "core/orbit", "orbit-node"})
    for (const auto& entry : fs::directory_iterator(fs::path(DMISE_SOURCE_DIR) / directory)) {
      const std::string extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".h") continue;
      ++files;
      std::ifstream file(entry.path());
      std::string line;
      for (int number = 1; std::getline(file, line); ++number)
        EXPECT_FALSE(std::regex_search(code_of(line), single))
            << entry.path() << ":" << number << ": " << line;
    }
  EXPECT_GT(files, 50);
}

}  // namespace
}  // namespace dmise
