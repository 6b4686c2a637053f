#pragma once
#include <cstdio>
#include <string>

#include "core/frames/vec.h"

namespace dmise {

/// Metadata of an ephemeris file.
struct OemSubject {
  std::string object_name;
  std::string object_id;      // international designator, or another name
  std::string creation_date;  // a simulation states its start, so that the bytes repeat
};

/// A line of an ephemeris: time, position [km] to 1e-9, velocity [km/s] to 1e-12.
std::string oem_state_line(const std::string& utc, const Vec<Gcrs>& position_m,
                           const Vec<Gcrs>& velocity_m_per_s);

/// Writes a CCSDS Orbit Ephemeris Message (502.0-B) in KVN, one state at a time, in GCRF and UTC;
/// the file is complete, with a correct STOP_TIME, after each. A state alone is a segment too;
/// there is no file before the first. Characters of names that are not printable ASCII become ?.
class OemFile {
 public:
  /// Does not write yet. Times are texts of one length that sort chronologically (`format_utc`).
  OemFile(std::string path, OemSubject subject);
  ~OemFile();
  OemFile(const OemFile&) = delete;
  OemFile& operator=(const OemFile&) = delete;

  /// Starts a new file: removes an earlier one. Throws `Error` "PATH: reason", as all methods do.
  void begin();
  /// Continues the file of an earlier process, without the states at `utc` and later.
  void keep_before(const std::string& utc);
  /// `previous_utc`: time of the preceding state of the object; if it is not that of the last one
  /// added, a new segment begins.
  void add(const std::string& utc, const std::string& previous_utc, const Vec<Gcrs>& position_m,
           const Vec<Gcrs>& slope_m_per_s);

 private:
  void open(const char* mode);
  void write(const std::string& text, long offset = 0, int from = SEEK_END);
  [[noreturn]] void fail() const;

  std::string path_;
  OemSubject subject_;
  std::FILE* file_ = nullptr;  // none before the first state
  std::string last_utc_;       // last state of the open segment; empty: none is open
  long stop_at_ = 0;           // where its STOP_TIME stands
};

}  // namespace dmise
