#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/config/sensors/sensor_settings.h"
#include "sensors/observatory/drive.h"

namespace dmise {

/// Places of a camera's filter wheel: its band, then `filters` of the camera file.
int filter_count(const Camera& camera);
std::vector<std::string> filter_places(const Camera& camera);
/// Puts the filter of a place, [0, filter_count), before the camera.
void set_filter(Camera& camera, int place);

/// A filter wheel, which turns the shorter way. Calls throw `DeviceError`.
class FilterWheel {
 public:
  static constexpr double places_per_s = 2.0;

  explicit FilterWheel(std::vector<std::string> names)
      : names_(std::move(names)), drive_("filter wheel", 0.0, places_per_s) {}

  const std::vector<std::string>& names() const { return names_; }
  /// [0, number of names); none while it turns.
  std::optional<int> place(SimTime now) const;
  int goal() const { return goal_; }
  void turn_to(int place, SimTime now);
  void need_still(SimTime now) const { drive_.need_still(now); }
  void hold_until(SimTime end) { drive_.hold_until(end); }

 private:
  std::vector<std::string> names_;
  Drive drive_;  // places that it has passed, up and down
  int goal_ = 0;
};

}  // namespace dmise
