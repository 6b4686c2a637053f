#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/sim_time.h"
#include "core/frames/quaternion.h"
#include "core/frames/vec.h"

namespace dmise {

/// Position of one thing at one tick.
struct PositionRow {
  Tick tick = 0;
  std::string time_utc;  // nine decimals
  std::string kind;      // camera, object, sun, moon
  std::string name;
  std::uint32_t catalogue_number = 0;        // of an object
  Vec<Gcrs> position_m;                      // geocentric
  std::optional<Vec<Gcrs>> slope_m_per_s;    // the derivative of the position
  std::optional<Quaternion> gcrs_from_axes;  // of a camera's or a body's axes; w >= 0
};

/// Header of the CSV table, with its newline.
std::string csv_header();

/// One line each, with its newline; numbers are the shortest text that reads back to the same bits.
std::string csv_line(const PositionRow& row);
std::string json_line(const PositionRow& row);

/// The tick of a complete line written by either; empty for any other line.
std::optional<Tick> tick_of_line(const std::string& line);

}  // namespace dmise
