#include "core/run/run_files.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/error.h"

namespace dmise {
namespace {

TEST(RunFiles, OfASensorAreThoseThatItWrites) {
  for (const char* name :
       {"frames.jsonl", "cost.jsonl.partial", "tasks.journal", "frame-000001.fits",
        "frame-1234567-marked.png", "frame-000002.stars.csv"})
    EXPECT_TRUE(is_file_of_sensor(name)) << name;
  for (const char* name : {"run.json", "tracks.jsonl", "frame-.fits", "frame-000001.tif", "frame",
                           "frame-000001", "notes.txt", "my-frame-000001.fits", ""})
    EXPECT_FALSE(is_file_of_sensor(name)) << name;
}

TEST(RunFiles, OneThatIsMissingSaysWhatTheRunLacks) {
  const std::string directory = testing::TempDir() + "/no-files";
  std::filesystem::create_directory(directory);
  try {
    existing_path(directory, run_file::tracks);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.what(), directory + "/tracks.jsonl: is missing: the scenario has no fusion");
  }
  std::filesystem::remove(directory);
}

}  // namespace
}  // namespace dmise
