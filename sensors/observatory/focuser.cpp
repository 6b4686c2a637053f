#include "sensors/observatory/focuser.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/config/sensors/band_wavelengths.h"
#include "core/optics/pupil_sampling.h"

namespace dmise {
namespace {

constexpr int longest_travel_um = 5000;    // small focusers have 5 to 20 mm
constexpr double widest_travel_px = 64.0;  // disc of a point: wider ones take seconds

/// Whether frames can be made so far out of focus.
bool can_blur(const SensorConfig& sensor, int focus_um) {
  const SensorConfig s = focused(sensor, focus_um, {});
  const Optics& optics = s.camera.optics;
  try {
    const PsfPlan plan = plan_psf(optics, s.camera.band.centre_m, s.seeing, s.exposure_s,
                                  AirTurbulence::level(s.effects));
    if (plan.method != PointSpread::Method::deposit)
      sample_pupils(optics, wavelengths_of(s.camera.band, optics.spread.wavelengths), plan,
                    s.seeing);
    return true;
  } catch (const ConfigError&) {
    return false;
  }
}

}  // namespace

SensorConfig focused(SensorConfig sensor, double focus_um, SimTime end) {
  if (focus_um == 0.0) return sensor;
  FocusDrift& drift = sensor.camera.optics.spread.drift;
  drift.start_um += focus_um;
  drift.run_s = std::max(drift.run_s, end.seconds());
  return sensor;
}

int focus_travel_um(const SensorConfig& sensor) {
  const Optics& optics = sensor.camera.optics;
  const double um_per_px = 1e6 * optics.pixel_pitch_m * optics.f_number();
  int travel_um = int(std::min(double(longest_travel_um), widest_travel_px * um_per_px));
  while (travel_um > 0 && !(can_blur(sensor, travel_um) && can_blur(sensor, -travel_um)))
    travel_um /= 2;
  return travel_um;
}

int Focuser::position(SimTime now) const { return int(std::lround(drive_.position(now))); }

void Focuser::move_to(int position, SimTime now) {
  if (max_step() == 0)
    throw DeviceError(DeviceFault::not_implemented,
                      "the camera file has optics.method: deposit, whose blur can't change");
  if (position < 0 || position > max_step())
    throw DeviceError(DeviceFault::invalid_value,
                      "the position must be 0 to " + std::to_string(max_step()));
  drive_.move_to(position, now);
}

}  // namespace dmise
