// A camera under commands, as ASCOM's ICamera says.
#include "sensors/observatory/camera_control.h"

#include <gtest/gtest.h>

#include <functional>

namespace dmise {
namespace {

DeviceFault camera_fault(const std::function<void()>& call) {
  try {
    call();
  } catch (const DeviceError& error) {
    return error.fault();
  }
  return DeviceFault{};
}

CameraControl small_camera() {
  CameraSettings settings;
  settings.camera.optics.columns = 64;
  settings.camera.optics.rows = 48;
  settings.camera.detector.adc_bits = 12;
  settings.camera.detector.temperature_c = -20.0;
  settings.camera.detector.dark_doubling_k = 6.0;
  settings.readout_s = 0.5;
  settings.ambient_c = 10.0;
  return CameraControl(settings);
}

CountImage ramp() {
  CountImage image(64, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) image.at(x, y) = std::uint16_t(x + 64 * y);
  return image;
}

TEST(CameraControl, ExposesReadsAndHasAnImage) {
  CameraControl camera = small_camera();
  const SimTime start = sim_seconds(100);
  EXPECT_EQ(camera.state(start), CameraState::idle);
  EXPECT_EQ(camera_fault([&] { camera.image(); }), DeviceFault::invalid_operation);
  EXPECT_EQ(camera_fault([&] { camera.last_exposure_s(); }), DeviceFault::invalid_operation);
  camera.open(camera.planned(4.0, start));
  EXPECT_EQ(camera.state(start + sim_seconds(3.9)), CameraState::exposing);
  EXPECT_EQ(camera.percent_completed(start + sim_seconds(1)), 25);
  EXPECT_EQ(camera_fault([&] { camera.planned(1.0, start + sim_seconds(1)); }),
            DeviceFault::invalid_operation);
  EXPECT_EQ(camera.state(start + sim_seconds(4.1)), CameraState::reading);
  EXPECT_FALSE(camera.image_ready());
  camera.deliver(ramp(), "2018-01-21T00:00:00.000");
  EXPECT_TRUE(camera.image_ready());
  EXPECT_EQ(camera.state(start + sim_seconds(5)), CameraState::idle);
  EXPECT_EQ(camera.last_exposure_s(), 4.0);
  EXPECT_EQ(camera.last_start_utc(), "2018-01-21T00:00:00.000");
  EXPECT_EQ(camera.image()->at(5, 7), 5 + 64 * 7);
  camera.open(camera.planned(1.0, start + sim_seconds(6)));
  EXPECT_FALSE(camera.image_ready());
}

TEST(CameraControl, EndsExposuresEarly) {
  CameraControl camera = small_camera();
  EXPECT_EQ(camera.stop({}), std::nullopt);
  EXPECT_FALSE(camera.abort({}));
  camera.open(camera.planned(10.0, {}));
  EXPECT_EQ(camera.stop(sim_seconds(4)), sim_seconds(4));
  EXPECT_EQ(camera.state(sim_seconds(4)), CameraState::reading);
  EXPECT_EQ(camera_fault([&] { camera.abort(sim_seconds(4.1)); }), DeviceFault::invalid_operation);
  camera.deliver(ramp(), "");
  EXPECT_EQ(camera.last_exposure_s(), 4.0);
  camera.open(camera.planned(10.0, sim_seconds(20)));
  EXPECT_TRUE(camera.abort(sim_seconds(21)));
  EXPECT_EQ(camera.state(sim_seconds(21)), CameraState::idle);
  EXPECT_FALSE(camera.image_ready());
}

TEST(CameraControl, RefusesExposuresThatItCannotTake) {
  CameraControl camera = small_camera();
  for (const double exposure_s : {-1.0, 0.0, 3601.0})
    EXPECT_EQ(camera_fault([&] { camera.planned(exposure_s, {}); }), DeviceFault::invalid_value);
  for (const int bin : {0, 9})
    EXPECT_EQ(camera_fault([&] { camera.set_bin(bin); }), DeviceFault::invalid_value);
  camera.set_size(65, std::nullopt);
  EXPECT_EQ(camera_fault([&] { camera.planned(1.0, {}); }), DeviceFault::invalid_value);
  camera.set_size(64, 48);
  camera.set_start(1, std::nullopt);
  EXPECT_EQ(camera_fault([&] { camera.planned(1.0, {}); }), DeviceFault::invalid_value);
  camera.set_start(-1, 0);
  EXPECT_EQ(camera_fault([&] { camera.planned(1.0, {}); }), DeviceFault::invalid_value);
  camera.fail("the disk is full");
  EXPECT_EQ(camera.state({}), CameraState::error);
  EXPECT_EQ(camera_fault([&] { camera.planned(1.0, {}); }), DeviceFault::driver);
}

// Sums by hand; 12 bits hold 4095.
TEST(CameraControl, BinsAndCutsImages) {
  CameraControl camera = small_camera();
  camera.set_bin(2);
  EXPECT_EQ(camera.window(), (Window{2, 2, 0, 0, 32, 24}));
  camera.set_start(3, 4);
  camera.set_size(2, 1);
  camera.set_bin(4);
  EXPECT_EQ(camera.window(), (Window{4, 4, 3, 4, 2, 1}));
  const CountImage part = window_of(ramp(), {2, 2, 3, 4, 2, 1}, 4095);
  ASSERT_EQ(part.columns, 2);
  ASSERT_EQ(part.rows, 1);
  const int left = 6 + 64 * 8, sum = left + (left + 1) + (left + 64) + (left + 65);
  EXPECT_EQ(part.at(0, 0), sum);
  EXPECT_EQ(part.at(1, 0), sum + 8);
  EXPECT_EQ(window_of(ramp(), {2, 2, 0, 23, 32, 1}, 4095).at(31, 0), 4095);
  EXPECT_EQ(window_of(ramp(), {1, 1, 60, 40, 4, 8}, 4095).at(3, 7), 63 + 64 * 47);
}

// An exponential of 30 s: after that time 1/e of the difference is left.
TEST(CameraControl, CoolsExponentially) {
  CameraControl camera = small_camera();
  EXPECT_EQ(camera.temperature_c({}), -20.0);
  camera.set_cooler(false, {});
  EXPECT_NEAR(camera.temperature_c(sim_seconds(30)), 10.0 - 30.0 * std::exp(-1.0), 1e-9);
  camera.set_cooler(true, sim_seconds(3000));
  camera.set_goal_c(-30.0, sim_seconds(3000));
  EXPECT_NEAR(camera.temperature_c(sim_seconds(3030)), -30.0 + 40.0 * std::exp(-1.0), 1e-6);
  EXPECT_NEAR(camera.planned(1.0, sim_seconds(6000)).temperature_c, -30.0, 1e-6);
  EXPECT_GT(camera.cooler_power_percent(sim_seconds(6000)), 0.0);
  EXPECT_EQ(camera_fault([&] { camera.set_goal_c(-300.0, {}); }), DeviceFault::invalid_value);
}

}  // namespace
}  // namespace dmise
