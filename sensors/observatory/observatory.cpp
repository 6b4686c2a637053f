#include "sensors/observatory/observatory.h"

#include <erfa.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <thread>

#include "core/base/cancellation.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "core/products/frame_file.h"
#include "core/run/run_files.h"
#include "core/time/iso8601.h"
#include "sensors/observatory/commanded_frames.h"
#include "sensors/observatory/scenario_sky.h"

namespace dmise {
namespace {

TelescopeSettings telescope_of(const SensorConfig& sensor, const ObservatorySettings& settings) {
  return {.latitude_deg = site_of(sensor)->latitude_deg,
          .slew_rate_deg_per_s = settings.slew_rate_deg_per_s,
          .settle_s = settings.settle_s,
          .min_elevation_deg = sensor.mask_deg,
          .roll_deg = sensor.roll_deg};
}

CameraSettings camera_of(const SensorConfig& sensor, const ObservatorySettings& settings) {
  CameraSettings camera{.camera = sensor.camera, .readout_s = settings.readout_s};
  camera.ambient_c =
      sensor.weather.air.value_or(standard_weather(site_of(sensor)->height_m)).temperature_c;
  return camera;
}

int frames_at_a_time(const ObservatorySettings& settings) {
  const int processors = std::max(1, int(std::thread::hardware_concurrency()));
  return std::max(1, processors / std::max(1, settings.threads));
}

void append_line(const std::string& path, const std::string& line) {
  std::ofstream file(path, std::ios::app);
  file << line << "\n" << std::flush;
  if (!file) throw Error(path + ": can't be written: " + std::strerror(errno));
}

/// The pointing of an exposure that is ended early.
CommandedPointing ended_early(CommandedPointing p, SimTime middle) {
  if (!p.follows) return p;
  const double t_s = (middle - p.reference).seconds();
  const double ra_deg = std::fmod(p.longitude_deg + p.longitude_rate_deg_per_s * t_s, 360.0);
  p.longitude_deg = ra_deg < 0.0 ? ra_deg + 360.0 : ra_deg;
  p.latitude_deg += p.latitude_rate_deg_per_s * t_s;
  p.reference = middle;
  return p;
}

}  // namespace

SimTime WallClock::now() const {
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
  return sim_seconds(passed.count() * rate_);
}

void WallClock::wait_until(SimTime t, std::unique_lock<std::mutex>& lock,
                           std::condition_variable& changed) const {
  const auto after = std::chrono::duration<double>(t.seconds() / rate_);
  changed.wait_until(lock, start_ + std::chrono::ceil<std::chrono::nanoseconds>(after));
}

struct Observatory::Station {
  Station(const Scenario& scenario, const ScenarioInputs& scene, const SensorConfig& config,
          const std::string& digest, const std::string& directory,
          const ObservatorySettings& settings, const Clock& clock)
      : sensor(config),
        sky(scenario, sensor, clock),
        telescope(telescope_of(sensor, settings), sky),
        camera(camera_of(sensor, settings)),
        focuser(focus_travel_um(sensor)),
        wheel(filter_places(sensor.camera)),
        weather([this](SimTime t) { return sky.conditions(t); }),
        frames(scenario, scene, sensor.name, digest, directory, settings.threads) {}

  const Malfunction* acting(MalfunctionKind kind, SimTime t) const {
    return dmise::acting(sensor.malfunctions, kind, t.seconds());
  }
  double readout_s(SimTime end) const {
    const Malfunction* slow = acting(MalfunctionKind::slow_download, end);
    return slow ? slow->download_s : camera.readout_s();
  }
  /// Where the camera points while the mount is stopped: as when that began. To be called before
  /// whatever moves the telescope.
  std::optional<CommandedPointing> stopped_pointing(SimTime now) {
    const Malfunction* stop = acting(MalfunctionKind::stopped_mount, now);
    const bool goes_on = stopped && stop && stop->at_s <= stopped->at_s + stopped->for_s;
    if (stop && !goes_on)
      stopped_at = telescope.standing_at(telescope.axis(sim_seconds(stop->at_s)));
    stopped = stop;
    return stop ? std::optional(stopped_at) : std::nullopt;
  }

  SensorConfig sensor;
  ScenarioSky sky;
  std::mutex mutex;  // guards what follows but `frames`, which the thread alone uses
  std::condition_variable changed;
  Telescope telescope;
  CameraControl camera;
  Focuser focuser;
  FilterWheel wheel;
  Cover cover;
  WeatherStation weather;
  const Malfunction* stopped = nullptr;  // why the mount stands; null: it works
  CommandedPointing stopped_at;
  std::optional<CommandedExposure> exposure;  // whose frame is to be made
  std::uint32_t frames_made = 0;
  bool ends = false;
  std::atomic<bool> unwanted = false;  // the frame that is being made
  CommandedFrames frames;
  std::thread thread;
};

Observatory::Observatory(const Scenario& scenario, const ScenarioInputs& scene,
                         const std::string& digest, const std::string& directory,
                         const ObservatorySettings& settings, const ObservatoryClock& clock,
                         std::function<void(const std::string&)> failed)
    : scenario_(scenario),
      utc_(make_clock(scenario)),
      clock_(clock),
      failed_(std::move(failed)),
      directory_(directory),
      journal_(path_in(directory, run_file::night)),
      turns_(frames_at_a_time(settings)) {
  for (const SensorConfig& sensor : commanded_sensors(scenario))
    stations_.push_back(
        std::make_unique<Station>(scenario, scene, sensor, digest, directory, settings, utc_));
  for (const auto& station : stations_)
    station->thread = std::thread([this, &station = *station] { make_frames(station); });
}

Observatory::~Observatory() {
  for (const auto& station : stations_) {
    const std::lock_guard lock(station->mutex);
    station->ends = true;
    station->unwanted = true;
    station->changed.notify_all();
  }
  turns_.wake();
  for (const auto& station : stations_) station->thread.join();
}

const SensorConfig& Observatory::sensor(std::size_t station) const {
  return stations_.at(station)->sensor;
}

std::string Observatory::utc(SimTime t) const {
  std::string text = format_utc(utc_.utc(t), 3);
  if (text.ends_with('Z')) text.pop_back();
  return text;
}

void Observatory::use(std::size_t station, const std::function<void(const Devices&)>& work) {
  Station& s = *stations_.at(station);
  const std::lock_guard lock(s.mutex);
  const SimTime now = clock_.now();
  s.stopped_pointing(now);
  work({s.telescope, s.camera, s.focuser, s.wheel, s.cover, s.weather, now});
}

bool Observatory::has_link(std::size_t station) const {
  return !stations_.at(station)->acting(MalfunctionKind::lost_link, clock_.now());
}

double Observatory::told_gain_e_per_dn(std::size_t station) const {
  const Malfunction* wrong =
      stations_.at(station)->acting(MalfunctionKind::wrong_gain, clock_.now());
  return wrong ? wrong->gain_e_per_dn : sensor(station).camera.detector.gain_e_per_dn;
}

double Observatory::sidereal_time_rad(std::size_t station) const {
  return stations_.at(station)->sky.sidereal_time_rad(clock_.now());
}

Equatorial Observatory::of_date(const Equatorial& icrs, SimTime t) const {
  const Tt tt = utc_.tt(t);
  double ra = 0.0, dec = 0.0, origins = 0.0;
  eraAtci13(icrs.ra_deg * deg, icrs.dec_deg * deg, 0.0, 0.0, 0.0, 0.0, tt.jd1, tt.jd2, &ra, &dec,
            &origins);
  return {eraAnp(ra - origins) / deg, dec / deg};
}

Equatorial Observatory::icrs_of(const Equatorial& of_date, SimTime t) const {
  const Tt tt = utc_.tt(t);
  const double origins = eraEo06a(tt.jd1, tt.jd2);
  double ra = 0.0, dec = 0.0, same_origins = 0.0;
  eraAtic13(of_date.ra_deg * deg + origins, of_date.dec_deg * deg, tt.jd1, tt.jd2, &ra, &dec,
            &same_origins);
  return {eraAnp(ra) / deg, dec / deg};
}

std::string Observatory::frame_path(std::size_t station, std::uint32_t frame) const {
  if (!scenario_.output.fits) return {};
  return directory_ + "/" + sensor(station).name + "/" + frame_file_name(frame);
}

int Observatory::frames_written() const {
  const std::lock_guard lock(journal_mutex_);
  return frames_written_;
}

void Observatory::follow_satellite(std::size_t station, const std::string& elements) {
  Station& s = *stations_.at(station);
  const auto path = s.sky.path_of(elements_in(elements));
  const std::lock_guard lock(s.mutex);
  const SimTime now = clock_.now();
  s.stopped_pointing(now);
  Vec<Enu> last = path->seen(now);
  const auto seen_or_last = [path, last](SimTime t) mutable {
    try {
      last = path->seen(t);
    } catch (const Error&) {  // it has decayed: the telescope stays where it was seen last
    }
    return last;
  };
  s.telescope.follow(seen_or_last, now);
}

/// What moves stands still until the shutter closes.
void Observatory::hold_until(Station& s, SimTime end) {
  s.telescope.hold_until(end);
  s.focuser.hold_until(end);
  s.wheel.hold_until(end);
  s.cover.hold_until(end);
}

void Observatory::start_exposure(std::size_t station, double exposure_s, bool light) {
  Station& s = *stations_.at(station);
  const std::lock_guard lock(s.mutex);
  const SimTime now = clock_.now();
  CommandedExposure exposure = s.camera.planned(exposure_s, now);
  exposure.sensor = s.sensor.name;
  exposure.frame = s.frames_made + 1;
  if (!is_within_run(scenario_, s.sensor, exposure.times()))
    throw DeviceError(DeviceFault::invalid_operation,
                      "the exposure would not end before the scenario does");
  const SimTime end = now + exposure.length;
  const auto stopped = s.stopped_pointing(now);
  exposure.pointing = s.telescope.pointing_during(now, end);
  if (stopped) exposure.pointing = *stopped;
  s.focuser.need_still(now);
  s.wheel.need_still(now);
  s.cover.need_still(now);
  exposure.focus_um = s.focuser.focus_um(now);
  exposure.filter = s.wheel.goal();
  exposure.dark = !light || s.cover.state(now) == CoverState::closed ||
                  s.acting(MalfunctionKind::stuck_shutter, now);
  hold_until(s, end);
  s.camera.open(exposure);
  s.exposure = std::move(exposure);
  s.changed.notify_all();
}

void Observatory::stop_exposure(std::size_t station) {
  Station& s = *stations_.at(station);
  const std::lock_guard lock(s.mutex);
  const SimTime now = clock_.now();
  const auto length = s.camera.stop(now);
  if (!length || !s.exposure) return;
  s.exposure->length = *length;
  s.exposure->pointing = ended_early(s.exposure->pointing, s.exposure->times().middle);
  hold_until(s, now);
  s.unwanted = true;
  s.changed.notify_all();
  turns_.wake();
}

void Observatory::abort_exposure(std::size_t station) {
  Station& s = *stations_.at(station);
  const std::lock_guard lock(s.mutex);
  const SimTime now = clock_.now();
  if (!s.camera.abort(now)) return;
  s.exposure.reset();
  hold_until(s, now);
  s.unwanted = true;
  s.changed.notify_all();
  turns_.wake();
}

void Observatory::make_frames(Station& station) {
  std::unique_lock lock(station.mutex);
  while (true) {
    station.changed.wait(lock, [&] { return station.ends || station.exposure; });
    if (station.ends) return;
    try {
      make_frame(station, lock);
    } catch (const Cancelled&) {
      if (!lock.owns_lock()) lock.lock();
    } catch (const std::exception& error) {
      if (!lock.owns_lock()) lock.lock();
      const std::string reason = station.sensor.name + ": " + error.what();
      station.camera.fail(reason);
      station.exposure.reset();
      failed_(reason);
    }
  }
}

/// Makes the frame while the shutter is open; then waits for its end. An exposure that was ended
/// early is made again, one that was aborted is forgotten.
void Observatory::make_frame(Station& station, std::unique_lock<std::mutex>& lock) {
  const CommandedExposure exposure = *station.exposure;
  const SimTime end = exposure.start + exposure.length;
  const SimTime ready = end + sim_seconds(station.readout_s(end));
  station.unwanted = false;
  lock.unlock();
  FrameProducts frame;
  {
    const FrameTurns::Turn turn = turns_.take(ready, station.unwanted);
    const CancellationScope scope(station.unwanted);
    frame = station.frames.make(exposure);
  }
  lock.lock();
  while (!station.ends && station.exposure == exposure && clock_.now() < ready)
    clock_.wait_until(ready, lock, station.changed);
  if (station.ends || station.exposure != exposure) return;
  lock.unlock();  // until its image is delivered, nobody can stop or abort it
  station.frames.write(frame);
  add_to_journal(exposure);  // before the image: whatever a client has seen can be made again
  lock.lock();
  station.camera.deliver(frame.counts, utc(exposure.start), frame.header);
  station.exposure.reset();
  ++station.frames_made;
}

void Observatory::add_to_journal(const CommandedExposure& exposure) {
  const std::lock_guard lock(journal_mutex_);
  append_line(journal_, to_json(exposure));
  ++frames_written_;
}

void replay_night(const Scenario& scenario, const ScenarioInputs& scene,
                  const std::vector<CommandedExposure>& night, const std::string& digest,
                  const std::string& directory, int threads,
                  const std::function<bool(const CommandedExposure&)>& after) {
  std::map<std::string, std::unique_ptr<CommandedFrames>> sensors;
  for (const SensorConfig& sensor : commanded_sensors(scenario))
    sensors[sensor.name] =
        std::make_unique<CommandedFrames>(scenario, scene, sensor.name, digest, directory, threads);
  for (const CommandedExposure& exposure : night) {
    CommandedFrames& frames = *sensors.at(exposure.sensor);
    frames.write(frames.make(exposure));
    append_line(path_in(directory, run_file::night), to_json(exposure));
    if (!after(exposure)) return;
  }
}

}  // namespace dmise
