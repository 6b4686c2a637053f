#include "launch/dataset/dataset_directory.h"
#include "launch/dataset/dataset_growth.h"

#include <gtest/gtest.h>

#include <atomic>
#include <barrier>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include "core/base/error.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

struct DatasetDirectories : testing::Test {
  DatasetDirectories() {
    std::string path = testing::TempDir() + "dmise-dataset-XXXXXX";
    directory = mkdtemp(path.data());
  }
  ~DatasetDirectories() override { fs::remove_all(directory); }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(directory + "/" + name).parent_path());
    std::ofstream(directory + "/" + name) << text;
  }
  std::string text_of(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(directory + "/" + name).rdbuf();
    return text.str();
  }
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(directory))
      all.insert(fs::relative(entry.path(), directory).string());
    return all;
  }
  static DatasetPlan plan(const std::string& digest = "one") {
    return {.last_seed = 4,
            .seeds_per_shard = 2,
            .scenario_text = "# of " + digest + "\n",
            .digest = digest};
  }
  DatasetDirectory open(const std::string& digest = "one") const {
    return {directory, plan(digest)};
  }
  /// The message with which a task is refused; empty if it begins.
  std::string refusal(const DatasetTask& task = {}, bool force = false,
                      const std::string& digest = "one") const {
    try {
      open(digest).begin(task, force);
    } catch (const ConfigError& e) {
      return std::string(e.what()).substr(directory.size() + 2);
    }
    return "";
  }
  static void make(DatasetDirectory& dataset, const DatasetTask& task = {}) {
    for (std::size_t shard = 0; shard < plan().shards(); ++shard) {
      if (!task.makes(shard)) continue;
      for (std::uint64_t seed = plan().first_of(shard); seed <= plan().last_of(shard); ++seed)
        dataset.write_sample(seed, {{.key = "k", .members = "", .coco_image = "{\"width\":1}"}});
      dataset.assemble(shard);
    }
  }

  const std::set<std::string> complete{".dataset-lock",      "coco.json",    "dataset-000000.tar",
                                       "dataset-000001.tar", "dataset.json", "scenario.yaml"};
  std::string directory;
};

TEST_F(DatasetDirectories, HaveTheFilesOfADataSet) {
  DatasetDirectory dataset = open();
  ASSERT_TRUE(dataset.begin({}, false));
  make(dataset);
  EXPECT_EQ(dataset.finish(), 0u);
  EXPECT_EQ(names(), complete);
  EXPECT_EQ(text_of("scenario.yaml"), "# of one\n");
  EXPECT_FALSE(open().begin({}, false));
  EXPECT_EQ(refusal({}, false, "two"),
            "contains another data set; --force replaces it, --out writes elsewhere");
}

TEST_F(DatasetDirectories, WithoutAFileThatTheManifestListsAreRefused) {
  DatasetDirectory dataset = open();
  ASSERT_TRUE(dataset.begin({}, false));
  make(dataset);
  ASSERT_EQ(dataset.finish(), 0u);
  for (const char* name : {"coco.json", "dataset-000001.tar"}) {
    const std::string whole = text_of(name), size = std::to_string(whole.size());
    write(name, whole.substr(1));
    EXPECT_EQ(refusal(), std::string(name) + " has " + std::to_string(whole.size() - 1) +
                             " bytes, by dataset.json it has " + size + "; --force makes all anew");
    fs::remove(directory + "/" + name);
    EXPECT_EQ(refusal(), std::string(name) + " is missing, by dataset.json it has " + size +
                             "; --force makes all anew");
    write(name, whole);
  }
  EXPECT_FALSE(open().begin({}, false));
}

TEST_F(DatasetDirectories, MakeDamagedPartsAgain) {
  DatasetDirectory dataset = open();
  ASSERT_TRUE(dataset.begin({}, false));
  const std::vector<SampleFrame> frames{{.key = "k", .members = "0123456789"}};
  for (const std::uint64_t seed : {1, 2}) dataset.write_sample(seed, frames);
  EXPECT_TRUE(dataset.has_sample(1));
  write("parts/sample-1.tar", "01234");
  EXPECT_FALSE(dataset.has_sample(1));
  write("parts/sample-1.tar", "0123456780");
  EXPECT_THROW(dataset.assemble(0), Error);
  dataset.write_sample(1, frames);
  dataset.assemble(0);
  EXPECT_TRUE(dataset.has_shard(0));
  write("dataset-000000.tar", "");
  EXPECT_FALSE(dataset.has_shard(0));
}

TEST_F(DatasetDirectories, WithFilesThatAreOfNoDataSetAreRefused) {
  for (const char* name : {"scenario.yaml", "coco.json", "dataset-000007.tar", "parts/my-file"}) {
    write(name, "mine");
    const auto before = names();
    EXPECT_EQ(refusal(), std::string("contains ") + name +
                             ", which is of no data set there; --force replaces files of such "
                             "names, --out writes elsewhere");
    EXPECT_EQ(names(), before);
    EXPECT_EQ(text_of(name), "mine");
    fs::remove(directory + "/" + name);
  }
  write("dataset-backup.tar", "mine");
  write("train.yaml", "mine");
  EXPECT_EQ(refusal(), "");
}

TEST_F(DatasetDirectories, ForceReplacesFilesWithNamesOfADataSetAndNoOthers) {
  for (const char* name : {"scenario.yaml", "coco.json", "dataset-000007.tar",
                           "dataset-000008.tar.partial", "parts/sample-3.tar"})
    write(name, "old");
  const std::set<std::string> own{"dataset-backup.tar", "dataset-1.tar", "notes/a", "parts/my-file",
                                  "parts/sample-three.tar"};
  for (const auto& name : own) write(name, "mine");
  DatasetDirectory dataset = open();
  ASSERT_TRUE(dataset.begin({}, true));
  EXPECT_FALSE(dataset.has_sample(3));
  make(dataset);
  EXPECT_EQ(dataset.finish(), 0u);
  auto expected = complete;
  expected.insert(own.begin(), own.end());
  expected.insert({"notes", "parts"});
  EXPECT_EQ(names(), expected);
  for (const auto& name : own) EXPECT_EQ(text_of(name), "mine") << name;
}

TEST_F(DatasetDirectories, WithWhatCannotBeRemovedAreNotForced) {
  write("coco.json/mine", "mine");
  EXPECT_THROW(open().begin({}, true), Error);
  EXPECT_EQ(text_of("coco.json/mine"), "mine");
}

TEST_F(DatasetDirectories, AreNotForcedWhileAProcessWorksInThem) {
  DatasetDirectory dataset = open();
  ASSERT_TRUE(dataset.begin({.number = 1, .count = 2}, false));
  make(dataset, {.number = 1, .count = 2});
  const auto before = names();
  for (const char* digest : {"one", "two"})
    EXPECT_EQ(refusal({}, true, digest), "another process works in this directory");
  EXPECT_EQ(names(), before);
}

TEST_F(DatasetDirectories, HaveTasksThatShareNoArchive) {
  const DatasetTask first{.number = 1, .count = 2}, second{.number = 2, .count = 2};
  std::optional<DatasetDirectory> dataset(open());
  ASSERT_TRUE(dataset->begin(first, false));
  EXPECT_EQ(refusal(first), "another process works on --shard 1/2");
  EXPECT_EQ(refusal({}),
            "other processes make this data set, with another n of --shard i/n, got 1/1");
  EXPECT_EQ(refusal({.number = 3, .count = 3}),
            "other processes make this data set, with another n of --shard i/n, got 3/3");
  EXPECT_EQ(refusal(second), "");
  dataset.reset();
  EXPECT_EQ(refusal({}), "");  // continued with another number when none works
}

TEST_F(DatasetDirectories, BelongToOneOfTwoThatBeginTogether) {
  for (int round = 0; round < 30; ++round) {
    std::atomic<int> begun{0};
    std::barrier together(2);
    const auto task = [&](const char* digest, std::uint64_t number) {
      DatasetDirectory dataset = open(digest);
      together.arrive_and_wait();
      try {
        begun += dataset.begin({.number = number, .count = 2}, false);
      } catch (const ConfigError&) {
      }
      together.arrive_and_wait();  // holds its locks until then
    };
    std::thread other(task, "two", 2);
    task("one", 1);
    other.join();
    ASSERT_EQ(begun, 1) << round;
    fs::remove_all(directory);
  }
}

TEST_F(DatasetDirectories, EndWithTheLastTask) {
  const DatasetTask first{.number = 1, .count = 2}, second{.number = 2, .count = 2};
  DatasetDirectory one = open(), two = open();
  ASSERT_TRUE(one.begin(first, false));
  ASSERT_TRUE(two.begin(second, false));
  make(one, first);
  EXPECT_EQ(one.finish(), 1u);
  make(two, second);
  EXPECT_EQ(two.finish(), 0u);
  EXPECT_TRUE(fs::exists(directory + "/dataset.json"));
  EXPECT_EQ(one.finish(), 0u);
  EXPECT_EQ(names(), complete);
}

// As a process that was stopped while it removed a data set by force leaves it.
TEST_F(DatasetDirectories, AreNotCompleteWithoutAnArchive) {
  DatasetDirectory dataset = open();
  ASSERT_TRUE(dataset.begin({}, false));
  make(dataset);
  fs::remove(directory + "/dataset-000001.tar");
  EXPECT_EQ(dataset.finish(), 1u);
  EXPECT_FALSE(fs::exists(directory + "/dataset.json"));
}

TEST_F(DatasetDirectories, RefusePartsOfAnotherDataSet) {
  DatasetDirectory dataset = open();
  ASSERT_TRUE(dataset.begin({}, false));
  make(dataset);
  open("two").write_sample(1, {{.key = "k", .members = "", .coco_image = "{}"}});
  open("one").write_sample(2, {{.key = "k", .members = "", .coco_image = "{}"}});
  EXPECT_THROW(dataset.assemble(0), Error);
  const std::string part = directory + "/parts/dataset-000001.coco";
  ASSERT_TRUE(fs::exists(part));
  std::ofstream(part) << "dataset two\nimage {}\n";
  EXPECT_THROW(dataset.finish(), Error);
  EXPECT_FALSE(fs::exists(directory + "/dataset.json"));
}

struct GrowingDataSets : DatasetDirectories {
  static DatasetPlan seeds(std::uint64_t first, std::uint64_t last) {
    DatasetPlan wanted = plan();
    wanted.first_seed = first;
    wanted.last_seed = last;
    return wanted;
  }
  static std::vector<SampleFrame> frames_of(std::uint64_t seed) {
    const std::string n = std::to_string(seed);
    std::vector<SampleFrame> frames{
        {.key = n, .members = "m" + n, .coco_image = "{\"width\":" + n + "}"}};
    for (std::uint64_t k = 0; k < seed % 3; ++k)
      frames.front().coco_annotations.push_back("{\"area\":" + n +
                                                ",\"shard\":" + std::to_string(k) + "}");
    return frames;
  }
  /// Makes what is missing; returns the seeds that were made.
  static std::vector<std::uint64_t> make_missing(const std::string& path, const DatasetPlan& asked,
                                                 std::uint64_t stop_at = 0) {
    const DatasetPlan all = grown_plan(path, asked);
    DatasetDirectory dataset(path, all);
    std::vector<std::uint64_t> made;
    if (!dataset.begin({}, false)) return made;
    for (std::size_t shard = 0; shard < all.shards(); ++shard) {
      if (dataset.has_shard(shard)) continue;
      for (std::uint64_t seed = all.first_of(shard); seed <= all.last_of(shard); ++seed) {
        if (seed == stop_at) return made;
        if (dataset.has_sample(seed)) continue;
        dataset.write_sample(seed, frames_of(seed));
        made.push_back(seed);
      }
      dataset.assemble(shard);
    }
    EXPECT_EQ(dataset.finish(), 0u);
    return made;
  }
  std::string refused(const DatasetPlan& asked) const {
    try {
      grown_plan(directory, asked);
    } catch (const ConfigError& e) {
      const std::string text = e.what();
      const std::size_t at = text.find(directory);
      return text.substr(0, at) + text.substr(at + directory.size());
    }
    return "";
  }
  using Seeds = std::vector<std::uint64_t>;
};

TEST_F(GrowingDataSets, HaveTheBytesOfOneThatIsMadeAtOnce) {
  const std::string once = directory + "/once", twice = directory + "/twice";
  make_missing(once, seeds(1, 9));
  EXPECT_EQ(make_missing(twice, seeds(1, 4)), (Seeds{1, 2, 3, 4}));
  EXPECT_EQ(make_missing(twice, seeds(5, 7)), (Seeds{5, 6, 7}));
  EXPECT_EQ(make_missing(twice, seeds(8, 9)), (Seeds{7, 8, 9}));  // 7 was in an archive of one
  EXPECT_EQ(make_missing(twice, seeds(1, 9)), Seeds{});
  EXPECT_EQ(make_missing(twice, seeds(3, 6)), Seeds{});
  for (const char* name : {"dataset.json", "coco.json", "dataset-000000.tar", "dataset-000001.tar",
                           "dataset-000003.tar", "dataset-000004.tar"})
    EXPECT_EQ(text_of(std::string("twice/") + name), text_of(std::string("once/") + name)) << name;
}

TEST_F(GrowingDataSets, GoOnAfterAnInterruption) {
  make_missing(directory, seeds(1, 4));
  EXPECT_EQ(make_missing(directory, seeds(5, 8), 7), (Seeds{5, 6}));
  EXPECT_FALSE(fs::exists(directory + "/dataset.json"));
  EXPECT_EQ(refused(seeds(1, 4)),
            "--seeds:  has seeds 1..8, unfinished; the command that began them continues");
  EXPECT_EQ(make_missing(directory, seeds(5, 8)), (Seeds{7, 8}));
  EXPECT_TRUE(fs::exists(directory + "/dataset.json"));
}

TEST_F(GrowingDataSets, RefuseSeedsThatDoNotJoin) {
  make_missing(directory, seeds(3, 6));
  for (const auto& [first, last] : {std::pair(1, 4), std::pair(8, 9)})
    EXPECT_EQ(refused(seeds(first, last)),
              "--seeds:  has seeds 3..6; more must begin with one of these or the next, got " +
                  std::to_string(first) + ".." + std::to_string(last));
  DatasetPlan other = seeds(7, 8);
  other.seeds_per_shard = 3;
  EXPECT_EQ(refused(other), "--per-shard:  has 2 seeds in an archive, got 3");
  other = seeds(7, 8);
  other.digest = "two";
  EXPECT_EQ(grown_plan(directory, other).first_seed, 7u);
  EXPECT_THROW(DatasetDirectory(directory, other).begin({}, false), ConfigError);
}

TEST_F(GrowingDataSets, RefuseToGrowWithoutTheirFiles) {
  make_missing(directory, seeds(1, 4));
  fs::remove(directory + "/dataset-000001.tar");
  EXPECT_THROW(make_missing(directory, seeds(5, 8)), ConfigError);
  EXPECT_TRUE(fs::exists(directory + "/dataset.json"));
}

}  // namespace
}  // namespace dmise
