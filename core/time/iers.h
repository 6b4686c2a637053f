#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace dmise {

/// Measured or predicted Earth rotation at one instant (IERS).
struct EarthRotationParameters {
  double ut1_minus_tai_s = 0.0;  // continuous, unlike UT1 - UTC
  double polar_motion_x_rad = 0.0;
  double polar_motion_y_rad = 0.0;
};

/// Daily values at 0h UTC of consecutive days.
class IersTable {
 public:
  /// Reads a `finals2000A` file (plain or gzip): Bulletin B where a line has it, else Bulletin A,
  /// measured or predicted; ends with the predictions. Throws `ConfigError` "PATH:LINE: reason".
  static IersTable read_finals2000a(const std::string& path);

  /// Linear between the daily values (error below 0.1 ms); empty outside the table. `utc_mjd`: days
  /// and fraction, UTC.
  std::optional<EarthRotationParameters> at(double utc_mjd) const;

  const EarthRotationParameters& last() const { return days_.back(); }
  std::int64_t first_mjd() const { return first_mjd_; }
  std::int64_t last_mjd() const { return first_mjd_ + static_cast<std::int64_t>(days_.size()) - 1; }

 private:
  std::int64_t first_mjd_ = 0;
  std::vector<EarthRotationParameters> days_;
};

}  // namespace dmise
