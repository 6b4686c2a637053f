#include "core/plan/cost_factors.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"

namespace dmise {
namespace {

std::string file_of(const std::string& text) {
  const std::string path = testing::TempDir() + "cost-factors.txt";
  std::ofstream(path) << text;
  return path;
}

TEST(CostFactors, AreReadAsTheyWereWritten) {
  const CostFactors factors{{"sky", 1.25}, {"stars", 0.5}};
  const std::string path = file_of(cost_factors_text(factors));
  EXPECT_EQ(load_cost_factors(path), factors);
  std::filesystem::remove(path);
}

TEST(CostFactors, NoFileIsNoFactors) { EXPECT_TRUE(load_cost_factors("/nowhere/at/all").empty()); }

TEST(CostFactors, RefuseWhatIsNoFactorByItsLine) {
  for (const std::string line : {"sky", "sky nan", "sky -1", "sky 0", "sky 1e9", "sky 1 2"}) {
    const std::string path = file_of("stars 2\n" + line + "\n");
    try {
      load_cost_factors(path);
      ADD_FAILURE() << line;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find(path + ":2: "), std::string::npos) << e.what();
    }
    std::filesystem::remove(path);
  }
}

}  // namespace
}  // namespace dmise
