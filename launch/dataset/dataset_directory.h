#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "launch/process/file_lock.h"
#include "sensors/dataset/sample_maker.h"

namespace dmise {

/// Content of a data set: seeds first..last, a fixed number of them in each archive.
struct DatasetPlan {
  std::uint64_t first_seed = 1, last_seed = 1;
  std::uint64_t seeds_per_shard = 100;
  std::string scenario_text;
  std::string digest;  // stands for everything that determines its bytes

  std::size_t shards() const { return std::size_t((last_seed - first_seed) / seeds_per_shard + 1); }
  std::uint64_t first_of(std::size_t shard) const { return first_seed + shard * seeds_per_shard; }
  std::uint64_t last_of(std::size_t shard) const {
    return std::min(last_seed, first_of(shard) + (seeds_per_shard - 1));
  }
};

/// A task of a job array: it makes the number-th of every `count` archives.
struct DatasetTask {
  std::uint64_t number = 1, count = 1;
  bool makes(std::size_t shard) const { return shard % count == number - 1; }
};

/// The directory of a data set: dataset-NNNNNN.tar, coco.json, scenario.yaml and, when all is done,
/// dataset.json. Work in progress is in parts/: samples, each complete or missing, from which
/// archives are put together. Several processes may work on different archives of one data set;
/// .dataset-lock, which is kept, has their locks. Files with other names are never touched.
class DatasetDirectory {
 public:
  /// Throws `Error` "PATH: reason" if it can't be made.
  DatasetDirectory(std::string path, DatasetPlan plan);

  /// Begins or continues the work of a task, which is locked for the lifetime of this object. A
  /// complete data set of the first of the seeds is kept and grows (`grown_plan`).
  /// `force` removes a data set, and files with the names of one. Returns false if this data set is
  /// complete. Throws `ConfigError` if there are files of another or of none, or other processes
  /// work on the same task, with another number of tasks or, with `force`, at all; and if files of
  /// a complete data set are missing or have another size than by its manifest.
  bool begin(const DatasetTask& task, bool force);

  /// Whether it is there, in its size; so also a sample.
  bool has_shard(std::size_t shard) const;
  bool has_sample(std::uint64_t seed) const;
  /// Writes a sample, complete or not at all.
  void write_sample(std::uint64_t seed, const std::vector<SampleFrame>& frames) const;
  /// Puts an archive together from its samples, which are then removed. Throws `Error` if one is
  /// of another data set, or damaged.
  void assemble(std::size_t shard) const;
  /// Writes coco.json and dataset.json if all archives exist, and ends the work. Returns the number
  /// of missing ones.
  std::size_t finish();

 private:
  // `fewer_complete`: a complete data set of the first of these seeds.
  enum class Content { nothing, same_unfinished, same_complete, fewer_complete };

  std::string part(const std::string& name) const { return path_ + "/parts/" + name; }
  /// Throws `ConfigError` for files of another data set or of none.
  Content content() const;
  std::string file_of_no_dataset() const;
  /// Returns whether no other process works in the directory; until the plan is written, none can
  /// begin then.
  bool lock(bool force);
  void require_tasks(const DatasetTask& task) const;
  void clear() const;
  void remove_parts() const;
  /// Makes a complete data set of fewer seeds an unfinished one of these.
  void reopen() const;
  /// Throws as `content`, and as `require_files`.
  bool is_complete() const;
  /// Throws `ConfigError` unless all files of a complete data set have the sizes of its manifest.
  void require_files(const DatasetPlan& plan) const;
  std::string lines_of(const std::string& part_name) const;
  std::string write_coco() const;

  std::string path_;
  DatasetPlan plan_;
  std::optional<FileLock> lock_;
};

/// "dataset-000007" + `ending`.
std::string shard_name(std::size_t shard, const char* ending = ".tar");

}  // namespace dmise
