#include "core/time/iers.h"

#include <string_view>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/base/numeric/table_place.h"
#include "core/base/units.h"
#include "core/time/leap_seconds.h"

namespace dmise {
namespace {

// Columns `first`..`last` of a line, counted from 1 as in the format's description.
std::optional<double> field(std::string_view line, std::size_t first, std::size_t last) {
  if (line.size() < last) return std::nullopt;
  return parse_real(trimmed(line.substr(first - 1, last - first + 1)));
}

}  // namespace

IersTable IersTable::read_finals2000a(const std::string& path) {
  const std::string content = read_text_file(path);
  IersTable table;
  LineReader lines(content);
  while (const auto line = lines.next()) {
    const auto fail = [&](const std::string& reason) {
      throw ConfigError(at_line(path, lines.line(), reason));
    };
    const std::optional<double> mjd = field(*line, 8, 15);
    if (!mjd) fail("no modified Julian date in columns 8-15 (not a finals2000A file?)");

    // Bulletin B is at the end of the line.
    std::optional<double> x = field(*line, 135, 144), y = field(*line, 145, 154),
                          dut1 = field(*line, 155, 165);
    if (!x || !y || !dut1)
      x = field(*line, 19, 27), y = field(*line, 38, 46), dut1 = field(*line, 59, 68);
    if (!x || !y || !dut1) break;  // beyond the predictions

    const auto day = static_cast<std::int64_t>(*mjd);
    if (table.days_.empty()) table.first_mjd_ = day;
    if (day != table.first_mjd_ + static_cast<std::int64_t>(table.days_.size()))
      fail("days are not consecutive, got " + std::to_string(day));
    table.days_.push_back({*dut1 - tai_minus_utc_s(day), *x * arcsec, *y * arcsec});
  }
  if (table.days_.empty()) throw ConfigError(path + ": contains no Earth orientation data");
  return table;
}

std::optional<EarthRotationParameters> IersTable::at(double utc_mjd) const {
  const double offset = utc_mjd - static_cast<double>(first_mjd_);
  if (!(offset >= 0.0) || offset > static_cast<double>(days_.size() - 1)) return std::nullopt;
  if (days_.size() == 1) return days_[0];
  const TablePlace place = table_place(offset, days_.size());
  const EarthRotationParameters &a = days_[place.node], &b = days_[place.node + 1];
  const auto mix = [&](double p, double q) { return p + place.part * (q - p); };
  return EarthRotationParameters{mix(a.ut1_minus_tai_s, b.ut1_minus_tai_s),
                                 mix(a.polar_motion_x_rad, b.polar_motion_x_rad),
                                 mix(a.polar_motion_y_rad, b.polar_motion_y_rad)};
}

}  // namespace dmise
