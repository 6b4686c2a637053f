#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "launch/file_lock.h"
#include "sensors/dataset/sample_maker.h"

namespace dmise {

/// What a data set holds: seeds first..last, a fixed number of them in each archive.
struct DatasetPlan {
  std::uint64_t first_seed = 1, last_seed = 1;
  std::uint64_t seeds_per_shard = 100;
  std::string scenario_text;
  std::string digest;  // of all that determines its bytes

  std::size_t shards() const { return std::size_t((last_seed - first_seed) / seeds_per_shard + 1); }
  std::uint64_t first_of(std::size_t shard) const { return first_seed + shard * seeds_per_shard; }
  std::uint64_t last_of(std::size_t shard) const {
    return std::min(last_seed, first_of(shard) + (seeds_per_shard - 1));
  }
};

/// The directory of a data set: dataset-NNNNNN.tar, coco.json, scenario.yaml and, when all is done,
/// dataset.json. What is under way lies in parts/: samples, each whole or not there, from which
/// archives are put together. Several processes may work on different archives.
class DatasetDirectory {
 public:
  enum class Content { nothing, same_unfinished, same_complete, another };

  /// Throws `Error` "PATH: reason" if it can't be made.
  DatasetDirectory(std::string path, DatasetPlan plan);

  Content content() const;
  /// Removes a data set.
  void clear() const;
  /// Notes the plan, so that others know whether they continue it.
  void begin() const;
  /// Held by who works on some of the archives; none if another process does.
  std::optional<FileLock> lock(const std::string& part) const;

  bool has_shard(std::size_t shard) const;
  bool has_sample(std::uint64_t seed) const;
  /// Leaves a sample, whole or not at all.
  void write_sample(std::uint64_t seed, const std::vector<SampleFrame>& frames) const;
  /// Puts an archive together from its samples, which are then removed.
  void assemble(std::size_t shard) const;
  /// Writes coco.json and dataset.json if all archives are there. Returns how many are missing.
  std::size_t finish() const;

 private:
  std::string part(const std::string& name) const { return path_ + "/parts/" + name; }
  std::string sample_part(std::uint64_t seed, const char* ending) const;
  std::string write_coco() const;

  std::string path_;
  DatasetPlan plan_;
};

/// "dataset-000007" + `ending`.
std::string shard_name(std::size_t shard, const char* ending = ".tar");

}  // namespace dmise
