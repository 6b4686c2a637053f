#include "sensors/observatory/filter_wheel.h"

namespace dmise {

int filter_count(const Camera& camera) { return 1 + int(camera.filters.size()); }

std::vector<std::string> filter_places(const Camera& camera) {
  std::vector<std::string> names{camera.band.name};
  for (const Filter& filter : camera.filters) names.push_back(filter.band.name);
  return names;
}

void set_filter(Camera& camera, int place) {
  if (place == 0) return;
  const Filter& filter = camera.filters.at(std::size_t(place) - 1);
  camera.band = filter.band;
  camera.magnitudes = filter.magnitudes;
}

std::optional<int> FilterWheel::place(SimTime now) const {
  if (drive_.is_moving(now)) return std::nullopt;
  return goal_;
}

void FilterWheel::turn_to(int place, SimTime now) {
  const int count = int(names_.size());
  if (place < 0 || place >= count)
    throw DeviceError(DeviceFault::invalid_value,
                      "the filter must be 0 to " + std::to_string(count - 1));
  drive_.need_rest(now);
  int way = place - goal_;
  if (2 * way > count) way -= count;
  if (2 * way < -count) way += count;
  drive_.move_to(drive_.goal() + way, now);
  goal_ = place;
}

}  // namespace dmise
