#include "sensors/objects/objects_in_field.h"

#include <algorithm>
#include <set>

#include "sensors/scene/view.h"
#include "tests/pipeline/harness.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

std::string from_orbit(const std::string& pointing, double exposure_s) {
  const std::string length = std::to_string(exposure_s);
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: " + length +
         ", tick_s: 30}\n"
         "objects: [{catalogue: demo}]\n"
         "sensors: [{name: a, platform: '25544', camera: geo-watch, pointing: {" +
         pointing + "}, exposure_s: " + length + ", cadence_s: " + length + "}]\n";
}

/// Objects whose direction falls on the frame at one second of the exposure at least.
std::set<std::size_t> asked_for_every_second(const View& view) {
  const auto& window = view.states();
  const Optics& optics = view.sensor().camera.optics;
  std::set<std::size_t> found;
  for (SimTime t = view.times().start; t < view.times().end; t.ns += 1'000'000'000) {
    const auto camera = view.camera_from_gcrs(t);
    const Vec<Gcrs> from_m = view.observer(t).position_m;
    for (std::size_t i = 0; i < window.object_count(); ++i) {
      if (view.platform() == i || !window.has_state(i, view.times().start) ||
          !window.has_state(i, view.times().middle) || !window.has_state(i, view.times().end))
        continue;
      const Vec<CameraFrame> line = camera * (window.motion(i, t).position_m - from_m);
      if (!(line.z > 0.0)) continue;
      const double f = optics.focal_length_px();
      if (std::abs(line.x) * f <= 0.5 * optics.columns * line.z &&
          std::abs(line.y) * f <= 0.5 * optics.rows * line.z)
        found.insert(i);
    }
  }
  return found;
}

// A camera in low orbit turns by 230 deg in an hour, and much faster for a while where it follows
// what passes near: its attitudes at start, middle and end do not bound that.
TEST(ObjectsInField, AnHoursExposureOfATurningCameraMissesNoObject) {
  for (const char* pointing : {"tracking: fixed", "target: '29499', tracking: target"}) {
    test::Stage stage(from_orbit(pointing, 3600.0));
    const auto& sensor = stage.scenario.sensors[0];
    const View view(sensor, frame_times(sensor, 1), stage.states);
    const auto every_second = asked_for_every_second(view);
    const auto found = objects_in_field(view);
    EXPECT_GE(every_second.size(), 5u) << pointing;
    for (const std::size_t i : every_second)
      EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i)) << pointing << ", " << i;
  }
}

// A mount that follows a low satellite over the zenith turns by a degree a second; far objects
// cross its field near the start and the end of a minute, and are degrees away from it in the
// middle.
TEST(ObjectsInField, AMountThatFollowsALowSatelliteMissesNoFarObject) {
  test::Stage stage(
      "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 62, tick_s: 31}\n"
      "objects: [{catalogue: demo}]\n"
      "sensors: [{name: a, site: {latitude_deg: -16.433, longitude_deg: -105.204, height_m: 0}, "
      "camera: wide-field-cmos, pointing: {target: '25544', tracking: target}, exposure_s: 62, "
      "cadence_s: 62}]\n");
  const auto& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  const auto every_second = asked_for_every_second(view);
  const auto found = objects_in_field(view);
  const auto far = std::count_if(every_second.begin(), every_second.end(), [&](std::size_t i) {
    const Vec<Gcrs> from_m = view.observer(view.times().middle).position_m;
    return norm(stage.states.motion(i, view.times().middle).position_m - from_m) > 15e6;
  });
  EXPECT_GE(far, 1);
  for (const std::size_t i : every_second)
    EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i)) << i;
}

}  // namespace
}  // namespace dmise
