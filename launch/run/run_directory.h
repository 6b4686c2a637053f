#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "launch/process/run_lock.h"

namespace dmise {

/// Output directory of a run, locked for the lifetime of this object, and its run.json.
class RunDirectory {
 public:
  /// Creates and locks `path`. Throws `Error` "PATH: reason" if it cannot be written, and
  /// `ConfigError` if it is in use.
  RunDirectory(std::string path, const Scenario& scenario, std::string digest);

  const std::string& path() const { return path_; }
  const std::string& digest() const { return digest_; }
  /// Hashes of the texts of the scenario's catalogues, as they were when this object was made.
  const std::vector<std::string>& catalogue_sha256() const { return catalogue_sha256_; }
  RunLock& lock() { return *lock_; }

  /// By its run.json. `no_run`: there is none; `unreadable`: it is damaged; `half_cleared`: a
  /// process died in `clear`.
  enum class Content {
    no_run,
    unreadable,
    half_cleared,
    same_run_complete,
    same_run_unfinished,
    another_run
  };
  Content content() const;

  /// Path of what a run would overwrite or add to; empty if there is none. Without a run.json it
  /// may be somebody else's.
  std::string in_the_way() const;

  /// Throws `ConfigError` if a sensor's directory is that of a run, which has a run.json.
  void check_sensor_directories() const;

  /// Whether the run went on without nodes that were lost, by its run.json. Throws `ConfigError`
  /// for one that is damaged.
  bool lacks_nodes() const;

  /// Removes products of an earlier run by their names; with `others` also those of sensors that
  /// the scenario lacks. Other files stay, and so do the directories that hold them and those with
  /// a run.json of their own. Leaves a run.json that says so.
  void clear(bool others);

  /// Merges the sensors' lines into detections.jsonl, truth.jsonl and frames.jsonl, sorted by
  /// (time, sensor, index). An incomplete last line is left out.
  void merge_lines() const;

 private:
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  std::string path_;
  const Scenario& scenario_;
  std::string digest_;
  std::vector<std::string> catalogue_sha256_;
  std::unique_ptr<RunLock> lock_;
};

/// Digest of everything that determines the products: the resolved scenario and the bytes of its
/// catalogues; the first 128 bits of their SHA-256.
std::string scenario_digest(const Scenario& scenario);

/// Totals of a sensor over its lines in frames.jsonl, detections.jsonl and cost.jsonl.
struct SensorSummary {
  std::string name;
  int frames = 0;
  int detections = 0;
  int objects = 0;  // with light in a frame, from the truth
  double seconds_per_frame = 0.0;
  double memory_mb = 0.0;  // largest reported PSS
};
std::vector<SensorSummary> summarise(const Scenario& scenario, const std::string& run_path);

/// Complete lines of a file; one without its newline was interrupted and is left out. None if the
/// file does not exist.
std::vector<std::string> whole_lines(const std::string& path);
/// Their number.
long count_lines(const std::string& path);

}  // namespace dmise
