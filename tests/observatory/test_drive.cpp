// Parts that move: where they are on their way, and what they refuse while a shutter is open.
#include "sensors/observatory/drive.h"

#include <gtest/gtest.h>

#include "sensors/observatory/cover.h"
#include "sensors/observatory/filter_wheel.h"
#include "sensors/observatory/focuser.h"

namespace dmise {
namespace {

template <class Call>
std::optional<DeviceFault> drive_fault(const Call& call) {
  try {
    call();
  } catch (const DeviceError& error) {
    return error.fault();
  }
  return std::nullopt;
}

TEST(Drive, GoesEvenlyAndStops) {
  Drive drive("drive", 10.0, 2.0);
  EXPECT_FALSE(drive.is_moving({}));
  drive.move_to(20.0, sim_seconds(1));
  EXPECT_EQ(drive.position(sim_seconds(3)), 14.0);
  EXPECT_TRUE(drive.is_moving(sim_seconds(5.9)));
  EXPECT_EQ(drive.position(sim_seconds(6)), 20.0);
  EXPECT_FALSE(drive.is_moving(sim_seconds(6)));
  drive.move_to(0.0, sim_seconds(10));
  drive.halt(sim_seconds(12));
  EXPECT_EQ(drive.position(sim_seconds(99)), 16.0);
}

TEST(Drive, RestsWhileAShutterIsOpen) {
  Drive drive("drive", 0.0, 1.0);
  drive.hold_until(sim_seconds(5));
  EXPECT_EQ(drive_fault([&] { drive.move_to(1.0, sim_seconds(4)); }),
            DeviceFault::invalid_operation);
  EXPECT_EQ(drive.position(sim_seconds(5)), 0.0);
  drive.move_to(1.0, sim_seconds(5));
  EXPECT_EQ(drive_fault([&] { drive.need_still(sim_seconds(5.5)); }),
            DeviceFault::invalid_operation);
  EXPECT_EQ(drive_fault([&] { drive.need_still(sim_seconds(6)); }), std::nullopt);
}

TEST(Focuser, HasThePlaceOfTheCameraFileInTheMiddle) {
  Focuser focuser(500);
  EXPECT_EQ(focuser.max_step(), 1000);
  EXPECT_EQ(focuser.position({}), 500);
  EXPECT_EQ(focuser.focus_um({}), 0.0);
  focuser.move_to(800, {});
  EXPECT_TRUE(focuser.is_moving(sim_seconds(0.1)));
  EXPECT_EQ(focuser.focus_um(sim_seconds(1)), 300.0);
  for (const int position : {-1, 1001})
    EXPECT_EQ(drive_fault([&] { focuser.move_to(position, sim_seconds(1)); }),
              DeviceFault::invalid_value);
  focuser.move_to(0, sim_seconds(1));
  focuser.halt(sim_seconds(1.10049));  // on a whole step
  EXPECT_EQ(focuser.position(sim_seconds(9)), 700);
  EXPECT_EQ(focuser.focus_um(sim_seconds(9)), 200.0);
}

/// f/4 with pixels of 10 um: a disc of a pixel is 40 um out of focus.
SensorConfig small_sensor() {
  SensorConfig sensor;
  Optics& optics = sensor.camera.optics;
  optics.columns = optics.rows = 64;
  optics.pixel_pitch_m = 1e-5;
  optics.focal_length_m = 0.4;
  optics.aperture_m = 0.1;
  sensor.exposure_s = 1.0;
  return sensor;
}

TEST(Focuser, GoesAsFarAsFramesCanBeMade) {
  SensorConfig sensor = small_sensor();
  EXPECT_EQ(focus_travel_um(sensor), 64 * 40);
  sensor.camera.optics.spread.method = PointSpread::Method::deposit;
  EXPECT_EQ(focus_travel_um(sensor), 0);
  Focuser fixed(0);
  EXPECT_EQ(drive_fault([&] { fixed.move_to(0, {}); }), DeviceFault::not_implemented);
}

TEST(Focuser, MovesTheDetectorOfTheSensor) {
  const SensorConfig sensor = focused(small_sensor(), -150.0, sim_seconds(100));
  EXPECT_NEAR(sensor.camera.optics.spread.drift.at_m(50.0), -150e-6, 1e-15);
  EXPECT_GE(sensor.camera.optics.spread.drift.max_m(), 150e-6);
  EXPECT_FALSE(focused(small_sensor(), 0.0, sim_seconds(100)).camera.optics.spread.drift.any());
}

TEST(FilterWheel, TurnsTheShorterWay) {
  FilterWheel wheel({"V", "B", "R", "I", "clear"});
  EXPECT_EQ(wheel.place({}), 0);
  wheel.turn_to(4, {});  // one place back
  EXPECT_EQ(wheel.place(sim_seconds(0.4)), std::nullopt);
  EXPECT_EQ(wheel.place(sim_seconds(0.5)), 4);
  wheel.turn_to(1, sim_seconds(1));  // two places on
  EXPECT_EQ(wheel.place(sim_seconds(1.9)), std::nullopt);
  EXPECT_EQ(wheel.place(sim_seconds(2)), 1);
  for (const int place : {-1, 5})
    EXPECT_EQ(drive_fault([&] { wheel.turn_to(place, sim_seconds(3)); }),
              DeviceFault::invalid_value);
  wheel.hold_until(sim_seconds(10));
  EXPECT_EQ(drive_fault([&] { wheel.turn_to(2, sim_seconds(9)); }), DeviceFault::invalid_operation);
  EXPECT_EQ(wheel.goal(), 1);
}

TEST(FilterWheel, PutsFiltersBeforeTheCamera) {
  Camera camera;
  camera.band.name = "V";
  Filter red;
  red.band.name = "R";
  red.magnitudes.solar_colour_mag = -0.3;
  camera.filters.push_back(red);
  EXPECT_EQ(filter_places(camera), (std::vector<std::string>{"V", "R"}));
  Camera same = camera;
  set_filter(same, 0);
  EXPECT_EQ(same.band.name, "V");
  set_filter(camera, 1);
  EXPECT_EQ(camera.band.name, "R");
  EXPECT_EQ(camera.magnitudes.solar_colour_mag, -0.3);
}

TEST(Cover, OpensAndClosesAndMayBeHalfOpen) {
  Cover cover;
  EXPECT_EQ(cover.state({}), CoverState::open);
  cover.close({});
  EXPECT_EQ(cover.state(sim_seconds(1)), CoverState::moving);
  EXPECT_EQ(cover.state(sim_seconds(2)), CoverState::closed);
  cover.open(sim_seconds(3));
  cover.halt(sim_seconds(4));
  EXPECT_EQ(cover.state(sim_seconds(4)), CoverState::unknown);
  EXPECT_EQ(drive_fault([&] { cover.need_still(sim_seconds(9)); }), DeviceFault::invalid_operation);
  cover.open(sim_seconds(9));
  EXPECT_EQ(cover.state(sim_seconds(10)), CoverState::open);
  EXPECT_EQ(drive_fault([&] { cover.need_still(sim_seconds(10)); }), std::nullopt);
}

}  // namespace
}  // namespace dmise
