#include "core/config/load_star_catalogue.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/config_error.h"

namespace dmise {
namespace {

/// An empty directory in which the variables of a user's directories point while it lives.
struct LoadStarCatalogue : testing::Test {
  LoadStarCatalogue() {
    std::filesystem::create_directories(directory_);
    for (const char* variable : {"XDG_CACHE_HOME", "XDG_DATA_HOME"})
      setenv(variable, directory_.c_str(), 1);
  }
  ~LoadStarCatalogue() override {
    for (const char* variable : {"XDG_CACHE_HOME", "XDG_DATA_HOME", "DMISE_HOME"})
      unsetenv(variable);
    std::filesystem::remove_all(directory_);
  }

  static std::string complaint(const std::string& name) {
    return test::config_error_of([&] { load_star_catalogue(name, "catalogue"); });
  }

  const std::filesystem::path directory_ = std::filesystem::path(testing::TempDir()) / "stars";
};

TEST_F(LoadStarCatalogue, ByNameOrFileOrNone) {
  EXPECT_EQ(load_star_catalogue("none"), nullptr);
  const auto usual = load_star_catalogue("");
  EXPECT_GT(usual->stars.size(), 100'000u);  // to V = 9
  EXPECT_EQ(load_star_catalogue("kstars")->stars.size(), usual->stars.size());
  const std::string file = directory_ / "two.csv";
  std::ofstream(file) << "ra_deg,dec_deg,mag_v\n10,20,5\n11,20,6\n";
  EXPECT_EQ(load_star_catalogue(file)->stars.size(), 2u);
}

TEST_F(LoadStarCatalogue, WhatIsMissingIsNamed) {
  setenv("DMISE_HOME", directory_.c_str(), 1);
  EXPECT_THAT(complaint("kstars"), testing::StartsWith("catalogue: " + directory_.string()));
  EXPECT_THAT(complaint("tycho2"), testing::StartsWith("catalogue: Tycho-2 is missing"));
  EXPECT_THAT(complaint("nothing.csv"), testing::StartsWith("nothing.csv: "));
}

}  // namespace
}  // namespace dmise
