#include "core/orbit/attitude_table.h"

#include <cmath>

#include "core/base/files/text_file.h"
#include "core/orbit/time_table.h"

namespace dmise {

namespace {

constexpr double min_length = 0.5, max_length = 2.0;  // wider than any rounding

}  // namespace

TableAttitude parse_attitude_table(std::string_view text, const std::string& source) {
  TableAttitude table;
  parse_time_table(text, source, "time_s,w,x,y,z", [&](const TimeTableRow& row) {
    const double* q = row.values.data() + 1;
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (!(length > min_length && length < max_length))
      row.fail("a quaternion of length " + std::to_string(length) + " is no attitude");
    table.time_s.push_back(row.values[0]);
    table.gcrs_from_body.push_back({q[0] / length, q[1] / length, q[2] / length, q[3] / length});
  });
  return table;
}

TableAttitude read_attitude_table(const std::string& path) {
  return parse_attitude_table(read_text_file(path), path);
}

}  // namespace dmise
