#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/config/make_clock.h"
#include "sensors/frames/load_scene.h"
#include "sensors/observatory/camera_control.h"
#include "sensors/observatory/cover.h"
#include "sensors/observatory/filter_wheel.h"
#include "sensors/observatory/focuser.h"
#include "sensors/observatory/frame_turns.h"
#include "sensors/observatory/site_conditions.h"
#include "sensors/observatory/telescope.h"

namespace dmise {

/// Simulation time as an observatory lives it.
class ObservatoryClock {
 public:
  virtual ~ObservatoryClock() = default;
  virtual SimTime now() const = 0;
  /// Waits until `t`, or until `changed` is notified; may return earlier.
  virtual void wait_until(SimTime t, std::unique_lock<std::mutex>& lock,
                          std::condition_variable& changed) const = 0;
};

/// Simulation time from now on: the start of the scenario, and what passes here times a rate.
class WallClock : public ObservatoryClock {
 public:
  explicit WallClock(double rate = 1.0) : rate_(rate) {}
  SimTime now() const override;
  void wait_until(SimTime t, std::unique_lock<std::mutex>& lock,
                  std::condition_variable& changed) const override;

 private:
  double rate_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// What the doors of an observatory call the devices of a sensor.
inline std::string telescope_name(const SensorConfig& sensor) { return sensor.name + " telescope"; }
inline std::string camera_name(const SensorConfig& sensor) { return sensor.name + " camera"; }
inline std::string focuser_name(const SensorConfig& sensor) { return sensor.name + " focuser"; }
inline std::string wheel_name(const SensorConfig& sensor) { return sensor.name + " filter wheel"; }
inline std::string cover_name(const SensorConfig& sensor) { return sensor.name + " cover"; }
inline std::string weather_name(const SensorConfig& sensor) { return sensor.name + " weather"; }

struct ObservatorySettings {
  double slew_rate_deg_per_s = 3.0, settle_s = 1.0, readout_s = 0.1;
  int threads = 1;  // for each sensor
};

/// The telescopes and cameras of a scenario, and what belongs to them, as clients command them.
/// Frames are made while the shutter is open, in a thread for each sensor, and written when it
/// closes. Calls may come from
/// any thread.
class Observatory {
 public:
  /// Station `i` has the i-th of `commanded_sensors`. All but `settings` must outlive it.
  /// `directory`: of the run. `failed` hears why a frame could not be made or written.
  Observatory(const Scenario& scenario, const ScenarioInputs& scene, const std::string& digest,
              const std::string& directory, const ObservatorySettings& settings,
              const ObservatoryClock& clock, std::function<void(const std::string&)> failed);
  /// Aborts open exposures.
  ~Observatory();
  Observatory(const Observatory&) = delete;
  Observatory& operator=(const Observatory&) = delete;

  std::size_t size() const { return stations_.size(); }
  const SensorConfig& sensor(std::size_t station) const;
  /// UTC as FITS has it: ISO 8601 without a Z.
  std::string utc(SimTime t) const;
  SimTime now() const { return clock_.now(); }

  /// What a client sees and commands at one station.
  struct Devices {
    Telescope& telescope;
    CameraControl& camera;
    Focuser& focuser;
    FilterWheel& wheel;
    Cover& cover;
    WeatherStation& weather;
    SimTime now;
  };
  /// Calls `work` with the devices, which nobody else uses meanwhile.
  void use(std::size_t station, const std::function<void(const Devices&)>& work);
  /// Returns what `ask` returns of the devices.
  template <class Ask>
  auto of(std::size_t station, const Ask& ask) {
    std::optional<decltype(ask(std::declval<const Devices&>()))> value;
    use(station, [&](const Devices& devices) { value = ask(devices); });
    return *std::move(value);
  }
  // Malfunctions of the scenario.
  /// Whether the devices answer.
  bool has_link(std::size_t station) const;
  /// The gain that the camera tells [e-/DN].
  double told_gain_e_per_dn(std::size_t station) const;
  double sidereal_time_rad(std::size_t station) const;
  // Places of the true equator and equinox of `t`: geocentric apparent places (ERFA), with the
  // Earth's aberration and the Sun's deflection of light, without air.
  Equatorial of_date(const Equatorial& icrs, SimTime t) const;
  Equatorial icrs_of(const Equatorial& of_date, SimTime t) const;

  /// Lets a telescope follow a satellite by an element set (TLE, OMM). Throws `DeviceError`.
  void follow_satellite(std::size_t station, const std::string& elements);
  // They throw `DeviceError`.
  /// `light`: false keeps the camera's shutter closed.
  void start_exposure(std::size_t station, double exposure_s, bool light = true);
  void stop_exposure(std::size_t station);
  void abort_exposure(std::size_t station);

  /// Where the file of a frame is; empty if the scenario wants none.
  std::string frame_path(std::size_t station, std::uint32_t frame) const;
  /// Number of frames whose products are written, of all sensors.
  int frames_written() const;

 private:
  struct Station;
  void hold_until(Station& station, SimTime end);
  void make_frames(Station& station);
  void make_frame(Station& station, std::unique_lock<std::mutex>& lock);
  void add_to_journal(const CommandedExposure& exposure);

  const Scenario& scenario_;
  Clock utc_;
  const ObservatoryClock& clock_;
  std::function<void(const std::string&)> failed_;
  std::string directory_, journal_;
  FrameTurns turns_;
  mutable std::mutex journal_mutex_;  // guards the journal and the number
  int frames_written_ = 0;
  std::vector<std::unique_ptr<Station>> stations_;
};

/// Makes the products of a night again, in the order of its exposures. `after` is called after
/// each.
void replay_night(const Scenario& scenario, const ScenarioInputs& scene,
                  const std::vector<CommandedExposure>& night, const std::string& digest,
                  const std::string& directory, int threads,
                  const std::function<bool(const CommandedExposure&)>& after);

/// A client's call of a station's devices, through a server with such kinds of device and such a
/// session with each.
template <class Kind, class Session>
struct StationCall {
  const Kind& kind;
  Observatory& observatory;
  std::size_t station;
  Session& session;

  /// Returns what `ask` returns of the station's devices.
  template <class Ask>
  auto of(const Ask& ask) const {
    return observatory.of(station, ask);
  }
  void on(const std::function<void(const Observatory::Devices&)>& work) const {
    observatory.use(station, work);
  }
  const SensorConfig& sensor() const { return observatory.sensor(station); }
};

}  // namespace dmise
