#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "launch/file_lock.h"
#include "sensors/dataset/sample_maker.h"

namespace dmise {

/// Content of a data set: seeds first..last, a fixed number of them in each archive.
struct DatasetPlan {
  std::uint64_t first_seed = 1, last_seed = 1;
  std::uint64_t seeds_per_shard = 100;
  std::string scenario_text;
  std::string digest;  // of everything that determines its bytes

  std::size_t shards() const { return std::size_t((last_seed - first_seed) / seeds_per_shard + 1); }
  std::uint64_t first_of(std::size_t shard) const { return first_seed + shard * seeds_per_shard; }
  std::uint64_t last_of(std::size_t shard) const {
    return std::min(last_seed, first_of(shard) + (seeds_per_shard - 1));
  }
};

/// The directory of a data set: dataset-NNNNNN.tar, coco.json, scenario.yaml and, when all is done,
/// dataset.json. Work in progress is in parts/: samples, each complete or missing, from which
/// archives are put together. Several processes may work on different archives.
class DatasetDirectory {
 public:
  enum class Content { nothing, same_unfinished, same_complete, another };

  /// Throws `Error` "PATH: reason" if it can't be made.
  DatasetDirectory(std::string path, DatasetPlan plan);

  Content content() const;
  /// Removes a data set.
  void clear() const;
  /// Writes the plan, by which other processes see whether they continue it.
  void begin() const;
  /// Locks a part of the work; empty if another process holds it.
  std::optional<FileLock> lock(const std::string& name) const;

  bool has_shard(std::size_t shard) const;
  bool has_sample(std::uint64_t seed) const;
  /// Writes a sample, complete or not at all.
  void write_sample(std::uint64_t seed, const std::vector<SampleFrame>& frames) const;
  /// Puts an archive together from its samples, which are then removed.
  void assemble(std::size_t shard) const;
  /// Writes coco.json and dataset.json if all archives exist. Returns the number of missing ones.
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
