#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "launch/run_lock.h"

namespace dmise {

/// The directory that a run writes into, which is its own as long as this lives, and what its
/// run.json says of it.
class RunDirectory {
 public:
  /// Makes `path` and locks it. Throws `Error` "PATH: reason" when that can't be written to, and
  /// `ConfigError` when it is in use.
  RunDirectory(std::string path, const Scenario& scenario, std::string digest);

  const std::string& path() const { return path_; }
  const std::string& digest() const { return digest_; }
  RunLock& lock() { return *lock_; }

  enum class Content { empty, same_run_complete, same_run_unfinished, another_run };
  Content content() const;

  /// Removes what an earlier run left, this or another: sensors' products, merged files, run.json.
  void clear();

  /// Merges the sensors' lines into detections.jsonl, truth.jsonl and frames.jsonl, sorted by
  /// (time, sensor, index). A line cut short by an interruption is left out.
  void merge_lines() const;

 private:
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  std::string path_;
  const Scenario& scenario_;
  std::string digest_;
  std::unique_ptr<RunLock> lock_;
};

/// Digest of all that decides the products: the resolved scenario and the bytes of its catalogues;
/// the first 128 bits of their SHA-256.
std::string scenario_digest(const Scenario& scenario);

/// Per sensor, summed over its lines in frames.jsonl, detections.jsonl and cost.jsonl.
struct SensorSummary {
  std::string name;
  int frames = 0;
  int detections = 0;
  int objects = 0;  // with light in a frame, from the truth
  double seconds_per_frame = 0.0;
  double memory_mb = 0.0;  // largest PSS reported
};
std::vector<SensorSummary> summarise(const Scenario& scenario, const std::string& run_path);

/// Whole lines of a file; 0 where there is none.
long count_lines(const std::string& path);

}  // namespace dmise
