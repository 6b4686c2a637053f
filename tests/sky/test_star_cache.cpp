#include "core/sky/star_cache.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>

#include "core/base/text_file.h"
#include "core/base/whole_file.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

class StarCache : public testing::Test {
 protected:
  void SetUp() override {
    std::string made = (fs::temp_directory_path() / "dmise-stars-XXXXXX").string();
    ASSERT_NE(mkdtemp(made.data()), nullptr);
    directory_ = made;
    source_ = directory_ + "/stars.csv";
    fs::create_directory(cache_ = directory_ + "/cache");
    write_file_whole(source_, "ra_deg,dec_deg,mag_v,bv\n10,20,3,0.1\n11,95,4,\n12,22,4,\n");
  }
  void TearDown() override { fs::remove_all(directory_); }

  std::string cached() const {
    for (const auto& entry : fs::directory_iterator(cache_)) return entry.path().string();
    return {};
  }

  std::string directory_, source_, cache_;
};

TEST_F(StarCache, TheSecondTimeGivesTheSameFromTheCache) {
  const StarMap first = load_star_map(source_, cache_), second = load_star_map(source_, cache_);
  EXPECT_FALSE(first.from_cache);
  EXPECT_TRUE(second.from_cache);
  EXPECT_EQ(first.stars, second.stars);
  EXPECT_EQ(first.problems.size(), 1u);
  EXPECT_EQ(first.problems, second.problems);
  EXPECT_EQ(first.stars.size(), 2u);
}

TEST_F(StarCache, AnotherSourceIsReadAnew) {
  load_star_map(source_, cache_);
  write_file_whole(source_, "ra_deg,dec_deg,mag_v\n1,2,3\n");
  const StarMap map = load_star_map(source_, cache_);
  EXPECT_FALSE(map.from_cache);
  EXPECT_EQ(map.stars.size(), 1u);
}

TEST_F(StarCache, DamageIsPassedOverAndMended) {
  const StarMap first = load_star_map(source_, cache_);
  const std::string whole = read_text_file(cached());
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    std::string damaged = whole;
    damaged[at] = char(damaged[at] ^ 0x40);
    write_file_whole(cached(), damaged);
    const StarMap again = load_star_map(source_, cache_);
    EXPECT_EQ(again.stars, first.stars) << at;
    write_file_whole(cached(), whole.substr(0, at));
    EXPECT_FALSE(load_star_map(source_, cache_).from_cache) << at;
  }
  EXPECT_TRUE(load_star_map(source_, cache_).from_cache);
}

TEST_F(StarCache, NoPlaceToKeepItIsNoError) {
  const StarMap map = load_star_map(source_, directory_ + "/absent");
  EXPECT_EQ(map.stars.size(), 2u);
  EXPECT_FALSE(map.cache_problem.empty());
}

}  // namespace
}  // namespace dmise
