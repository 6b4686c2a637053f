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

/// Writes positions.csv, positions.jsonl and positions/NAME-NUMBER.oem in a run's directory, tick
/// by tick, without wall-clock times. All methods throw `Error` "PATH: reason".
class PositionFiles {
 public:
  PositionFiles(std::string directory, const OutputConfig& output, std::string creation_date);
  ~PositionFiles();
  PositionFiles(const PositionFiles&) = delete;
  PositionFiles& operator=(const PositionFiles&) = delete;

  /// Opens the objects' ephemeris files; call once, before the others.
  void open_ephemerides(const std::vector<ObjectInfo>& objects);
  /// Keeps rows of an earlier process before `tick`, whose time is `utc`.
  void keep_before(Tick tick, const std::string& utc);
  /// Adds all rows of one tick; `previous_utc`: the time of the previous tick.
  void add(const std::vector<PositionRow>& rows, const std::string& previous_utc);

 private:
  struct Table {
    std::string path;
    std::FILE* file = nullptr;
  };
  void keep_lines_before(Table& table, Tick tick, const std::string& header);
  void append(Table& table, const std::string& lines);

  std::string directory_, creation_date_;
  bool with_oem_, in_enu_;
  Table csv_, json_;                                               // path empty: not written
  std::map<std::uint32_t, std::unique_ptr<OemFile>> ephemerides_;  // by catalogue number
};

/// Last tick with a complete line in positions.csv or positions.jsonl of a run's directory; -1 if
/// there is none.
Tick last_tick_written(const std::string& directory);

}  // namespace dmise
