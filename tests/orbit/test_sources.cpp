#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

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
  const std::regex single(
      R"(\bfloat\b|\b__m(128|256|512)\b|_ps\(|[0-9]\.[0-9]*f\b|\bstrtof\b|\bsqrtf\b)");
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

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Names of all tests, and the text of what registers scripts.
struct Tests {
  std::set<std::string> names;
  std::string scripts;
};
Tests all_tests(const fs::path& root) {
  Tests tests;
  const std::regex test(R"(TEST(_F|_P)?\(\s*(\w+),\s*(\w+)\))");
  for (const auto& entry : fs::recursive_directory_iterator(root / "tests")) {
    if (entry.path().filename() == "CMakeLists.txt") tests.scripts += text_of(entry.path());
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator m(text.begin(), text.end(), test), end; m != end; ++m)
      tests.names.insert((*m)[2].str() + "." + (*m)[3].str());
  }
  return tests;
}

// `Suite.Test`, or `Suite.Begins*`.
TEST(Sources, EveryTestThatTheModelsDocumentsNameExists) {
  const fs::path root(DMISE_SOURCE_DIR);
  const auto tests = all_tests(root).names;
  const std::regex name(R"(`([A-Z]\w+\.[A-Z]?\w*)(\*?)`)");
  int named = 0;
  for (const auto& entry : fs::directory_iterator(root / "docs/models")) {
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator m(text.begin(), text.end(), name), end; m != end; ++m, ++named) {
      const auto found = tests.lower_bound((*m)[1]);
      EXPECT_TRUE((*m)[2].length() ? found != tests.end() && found->starts_with((*m)[1].str())
                                   : tests.contains((*m)[1]))
          << entry.path() << ": " << m->str();
    }
  }
  EXPECT_GT(named, 30);
}

TEST(Sources, EveryTestThatTheTableOfHardCasesNamesExists) {
  const fs::path root(DMISE_SOURCE_DIR);
  const auto [tests, scripts] = all_tests(root);
  const std::string table = text_of(root / "docs/hard-cases.md");
  const std::regex name(R"(`(\w+)\.(\w+)`)");
  int named = 0;
  for (std::sregex_iterator m(table.begin(), table.end(), name), end; m != end; ++m, ++named) {
    const std::string suite = (*m)[1], rest = (*m)[2];
    if (suite == "system" || suite == "reference" || suite == "clients")
      EXPECT_NE(scripts.find(rest), scripts.npos) << m->str();
    else
      EXPECT_TRUE(tests.contains(suite + "." + rest)) << m->str();
  }
  EXPECT_GT(named, 40);
}

}  // namespace
}  // namespace dmise
