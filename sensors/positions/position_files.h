#pragma once
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "core/orbit/oem_file.h"
#include "core/sim/state.h"
#include "sensors/positions/position_row.h"

namespace dmise {

/// positions.csv, positions.jsonl and positions/NAME-NUMBER.oem in a run's directory, which grow by
/// a tick at a time and hold no wall clock. All throw `Error` "PATH: reason".
class PositionFiles {
 public:
  PositionFiles(std::string directory, const OutputConfig& output, std::string creation_date);
  ~PositionFiles();
  PositionFiles(const PositionFiles&) = delete;
  PositionFiles& operator=(const PositionFiles&) = delete;

  /// The objects that have an ephemeris file; called once, before the others.
  void open_ephemerides(const std::vector<ObjectInfo>& objects);
  /// Keeps what an earlier process wrote of ticks before `tick`, whose time is `utc`.
  void keep_before(Tick tick, const std::string& utc);
  /// All rows of one tick; `previous_utc`: the time of the tick before.
  void add(const std::vector<PositionRow>& rows, const std::string& previous_utc);

 private:
  struct Table {
    std::string path;
    std::FILE* file = nullptr;
  };
  void keep_lines_before(Table& table, Tick tick, const std::string& header);
  void append(Table& table, const std::string& lines);

  std::string directory_, creation_date_;
  bool with_oem_;
  Table csv_, json_;                                               // without a path: not wanted
  std::map<std::uint32_t, std::unique_ptr<OemFile>> ephemerides_;  // by catalogue number
};

/// Last tick of which positions.csv or positions.jsonl in a run's directory holds a whole line; -1:
/// none does.
Tick last_tick_written(const std::string& directory);

}  // namespace dmise
