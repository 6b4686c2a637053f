#include "core/time/iers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text_file.h"
#include "core/base/units.h"
#include "core/time/leap_seconds.h"

namespace dmise {
namespace {

// Columns `first`..`last` of a line, counted from 1 as in the format's description.
std::optional<double> field(std::string_view line, std::size_t first, std::size_t last) {
  if (line.size() < last) return std::nullopt;
  std::string_view text = line.substr(first - 1, last - first + 1);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

IersTable IersTable::read_finals2000a(const std::string& path) {
  const std::string content = read_text_file(path);
  IersTable table;
  std::size_t line_number = 0;
  for (std::size_t at = 0; at < content.size();) {
    const std::size_t end = std::min(content.find('\n', at), content.size());
    const std::string_view line(content.data() + at, end - at);
    at = end + 1;
    ++line_number;
    const auto fail = [&](const std::string& reason) -> ConfigError {
      return ConfigError(path + ":" + std::to_string(line_number) + ": " + reason);
    };
    const std::optional<double> mjd = field(line, 8, 15);
    if (!mjd) throw fail("no modified Julian date in columns 8-15 (not a finals2000A file?)");

    // Bulletin B is at the end of the line.
    std::optional<double> x = field(line, 135, 144), y = field(line, 145, 154),
                          dut1 = field(line, 155, 165);
    if (!x || !y || !dut1)
      x = field(line, 19, 27), y = field(line, 38, 46), dut1 = field(line, 59, 68);
    if (!x || !y || !dut1) break;  // beyond the predictions

    const auto day = static_cast<std::int64_t>(*mjd);
    if (table.days_.empty()) table.first_mjd_ = day;
    if (day != table.first_mjd_ + static_cast<std::int64_t>(table.days_.size()))
      throw fail("days are not consecutive, got " + std::to_string(day));
    table.days_.push_back({*dut1 - tai_minus_utc_s(day), *x * arcsec, *y * arcsec});
  }
  if (table.days_.empty()) throw ConfigError(path + ": contains no Earth orientation data");
  return table;
}

std::optional<EarthRotationParameters> IersTable::at(double utc_mjd) const {
  const double offset = utc_mjd - static_cast<double>(first_mjd_);
  if (!(offset >= 0.0) || offset > static_cast<double>(days_.size() - 1)) return std::nullopt;
  const std::size_t i =
      std::min(static_cast<std::size_t>(offset), days_.size() > 1 ? days_.size() - 2 : 0);
  if (days_.size() == 1) return days_[0];
  const double w = offset - static_cast<double>(i);
  const EarthRotationParameters &a = days_[i], &b = days_[i + 1];
  const auto mix = [w](double p, double q) { return p + w * (q - p); };
  return EarthRotationParameters{mix(a.ut1_minus_tai_s, b.ut1_minus_tai_s),
                                 mix(a.polar_motion_x_rad, b.polar_motion_x_rad),
                                 mix(a.polar_motion_y_rad, b.polar_motion_y_rad)};
}

}  // namespace dmise
