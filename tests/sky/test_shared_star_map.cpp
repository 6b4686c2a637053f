#include "core/sky/stars/shared_star_map.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "core/base/error.h"
#include "core/base/files/file_version.h"

namespace dmise {
namespace {

/// A directory of catalogues of some stars.
struct SharedStarMap : testing::Test {
  SharedStarMap() { std::filesystem::create_directories(directory_); }
  ~SharedStarMap() override { std::filesystem::remove_all(directory_); }

  std::string catalogue(const std::string& name, int stars) const {
    const std::string path = directory_ / name;
    std::ofstream file(path);
    file << "ra_deg,dec_deg,mag_v\n";
    for (int i = 1; i <= stars; ++i) file << i << ",20,5\n";
    file.close();
    while (!file_version(path)) std::this_thread::yield();  // as one written a while ago
    return path;
  }
  std::shared_ptr<const StarMap> share(const std::string& path) const {
    return share_star_map(path, directory_ / "cache");
  }

  const std::filesystem::path directory_ = std::filesystem::path(testing::TempDir()) / "shared";
};

TEST_F(SharedStarMap, IsLoadedOnce) {
  const std::string path = catalogue("a.csv", 2);
  const StarMap* first = share(path).get();
  EXPECT_EQ(share(path).get(), first);
  EXPECT_EQ(first->stars.size(), 2u);
}

TEST_F(SharedStarMap, AFileThatChangedIsLoadedAnew) {
  const std::string path = catalogue("a.csv", 2);
  const auto first = share(path);
  EXPECT_EQ(share(catalogue("a.csv", 3))->stars.size(), 3u);
  EXPECT_EQ(first->stars.size(), 2u);
}

TEST_F(SharedStarMap, AFileOfTheSameSizeAndTimeIsLoadedAnew) {
  const std::string path = catalogue("a.csv", 2);
  const auto time = std::filesystem::last_write_time(path);
  const auto first = share(path);
  std::ofstream(path) << "ra_deg,dec_deg,mag_v\n1,20,5\n2,20,7\n";
  std::filesystem::last_write_time(path, time);
  EXPECT_FLOAT_EQ(share(path)->stars.v_mag[0] + share(path)->stars.v_mag[1], 12.0f);
}

TEST_F(SharedStarMap, FewAreKept) {
  const std::weak_ptr<const StarMap> first = share(catalogue("a.csv", 1));
  const auto used = share(catalogue("b.csv", 2));
  EXPECT_FALSE(first.expired());
  share(catalogue("c.csv", 3));
  share(catalogue("d.csv", 4));
  EXPECT_TRUE(first.expired());
  EXPECT_EQ(share(directory_ / "b.csv"), used);  // as long as it is used
}

TEST_F(SharedStarMap, WhatIsMissingIsRefusedEachTime) {
  const std::string path = directory_ / "none.csv";
  EXPECT_THROW(share(path), ConfigError);
  EXPECT_THROW(share(path), ConfigError);
  EXPECT_EQ(share(catalogue("none.csv", 1))->stars.size(), 1u);
}

}  // namespace
}  // namespace dmise
