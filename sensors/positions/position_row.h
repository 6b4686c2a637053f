#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/sim_time.h"
#include "core/frames/quaternion.h"
#include "core/frames/vec.h"

namespace dmise {

/// A place in east, north and up of the scenario's origin, relative to it.
struct EnuPlace {
  Vec<Enu> position_m;
  std::optional<Vec<Enu>> velocity_m_per_s;  // relative to the turning axes
  std::optional<Quaternion> enu_from_axes;   // w >= 0
};

/// Position of one thing at one tick.
struct PositionRow {
  Tick tick = 0;
  std::string time_utc;  // nine decimals
  std::string kind;      // camera, object, sun, moon
  std::string name;
  std::uint32_t catalogue_number = 0;        // only objects have one
  Vec<Gcrs> position_m;                      // geocentric
  std::optional<Vec<Gcrs>> slope_m_per_s;    // the derivative of the position
  std::optional<Quaternion> gcrs_from_axes;  // axes of a camera or a body; w >= 0
  std::optional<EnuPlace> enu;               // what the tables have instead of GCRS
};

/// Header of the CSV table, with its newline.
std::string csv_header(bool enu = false);

/// One line each, with its newline; numbers are the shortest text that reads back to the same bits.
std::string csv_line(const PositionRow& row);
std::string json_line(const PositionRow& row);

/// The tick of a complete line written by either; empty for any other line.
std::optional<Tick> tick_of_line(const std::string& line);

}  // namespace dmise
