#include "sensors/observatory/commanded_exposure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/base/files/json.h"
#include "sensors/observatory/filter_wheel.h"
#include "sensors/observatory/focuser.h"

namespace dmise {
namespace {

double within(const JsonRecord& line, const char* key, double low, double high) {
  const double value = line.number(key);
  if (!(value >= low && value <= high))
    line.fail(key, "must be " + std::to_string(low) + " to " + std::to_string(high));
  return value;
}

CommandedPointing read_pointing(const JsonRecord& line) {
  CommandedPointing p{.follows = line.has("ra_deg")};
  p.roll_deg = within(line, "roll_deg", -720.0, 720.0);
  if (!p.follows) {
    p.longitude_deg = within(line, "azimuth_deg", 0.0, 360.0);
    p.latitude_deg = within(line, "elevation_deg", -90.0, 90.0);
    return p;
  }
  p.longitude_deg = within(line, "ra_deg", 0.0, 360.0);
  p.latitude_deg = within(line, "dec_deg", -90.0, 90.0);
  p.longitude_rate_deg_per_s =
      within(line, "ra_rate_deg_per_s", -max_rate_deg_per_s, max_rate_deg_per_s);
  p.latitude_rate_deg_per_s =
      within(line, "dec_rate_deg_per_s", -max_rate_deg_per_s, max_rate_deg_per_s);
  p.reference = line.time("reference_ns");
  return p;
}

Window read_window(const JsonRecord& line, const Optics& optics) {
  const auto whole = [&](double number) {
    if (!(number >= 0.0 && number <= 1e6) || number != std::floor(number))
      line.fail("window", "it and bin must be whole numbers from 0 to 1e6");
    return int(number);
  };
  const auto bin = line.numbers<2>("bin");
  const auto part = line.numbers<4>("window");
  Window w{whole(bin[0]),  whole(bin[1]),  whole(part[0]),
           whole(part[1]), whole(part[2]), whole(part[3])};
  const auto fits = [](int bin, int from, int count, int all) {
    return bin >= 1 && bin <= max_bin && from >= 0 && count >= 1 && count <= all / bin &&
           from <= all / bin - count;
  };
  if (!fits(w.bin_x, w.x, w.columns, optics.columns) || !fits(w.bin_y, w.y, w.rows, optics.rows))
    line.fail("window", "is not within the camera's " + std::to_string(optics.columns) + " x " +
                            std::to_string(optics.rows) + " pixels");
  return w;
}

/// What is before the detector; nights of earlier versions do not say.
void read_light_path(const JsonRecord& line, const SensorConfig& sensor, CommandedExposure& e) {
  const int places = filter_count(sensor.camera);
  if (line.has("filter")) e.filter = line.get<int>("filter");
  if (e.filter < 0 || e.filter >= places)
    line.fail("filter", "must be 0 to " + std::to_string(places - 1));
  if (line.has("focus_um")) e.focus_um = line.number("focus_um");
  if (e.focus_um != 0.0) {
    const double travel_um = focus_travel_um(sensor);
    within(line, "focus_um", -travel_um, travel_um);
  }
  if (line.has("dark")) e.dark = line.get<bool>("dark");
}

}  // namespace

std::string to_json(const CommandedExposure& e) {
  JsonWriter json;
  json.begin_object().field("sensor", e.sensor).field("frame", e.frame);
  json.field("start_ns", e.start.ns).field("exposure_ns", e.length.ns);
  const CommandedPointing& p = e.pointing;
  if (p.follows) {
    json.field("ra_deg", p.longitude_deg).field("dec_deg", p.latitude_deg);
    json.field("ra_rate_deg_per_s", p.longitude_rate_deg_per_s);
    json.field("dec_rate_deg_per_s", p.latitude_rate_deg_per_s);
    json.field("reference_ns", p.reference.ns);
  } else {
    json.field("azimuth_deg", p.longitude_deg).field("elevation_deg", p.latitude_deg);
  }
  json.field("roll_deg", p.roll_deg);
  const Window& w = e.window;
  json.list("bin", std::array{w.bin_x, w.bin_y});
  json.list("window", std::array{w.x, w.y, w.columns, w.rows});
  json.field("gain", e.gain).field("offset", e.offset);
  json.field("temperature_c", e.temperature_c);
  json.field("filter", e.filter).field("focus_um", e.focus_um).field("dark", e.dark);
  return json.end_object().take();
}

CommandedExposure read_commanded_exposure(const JsonRecord& line, const Scenario& scenario) {
  CommandedExposure e{.sensor = line.get<std::string>("sensor")};
  const auto sensor = std::ranges::find(scenario.sensors, e.sensor, &SensorConfig::name);
  if (sensor == scenario.sensors.end()) {
    std::vector<std::string> names;
    for (const SensorConfig& other : scenario.sensors) names.push_back(other.name);
    line.fail_as_none_of(names, "sensor", e.sensor);
  }
  if (!sensor->is_camera() || !site_of(*sensor))
    line.fail("sensor", e.sensor + " is no camera at a site");
  e.frame = line.get<std::uint32_t>("frame");
  e.start = line.time("start_ns");
  e.length = line.time("exposure_ns");
  if (e.length < sim_seconds(min_commanded_exposure_s) ||
      e.length > sim_seconds(max_commanded_exposure_s))
    line.fail("exposure_ns", "must be 1e6 to 3.6e12");
  if (e.start.ns < 0 || e.start > scenario.duration || !is_within_run(scenario, *sensor, e.times()))
    line.fail("start_ns", "the exposure is not within the scenario");
  e.pointing = read_pointing(line);
  if (e.pointing.follows &&
      (e.pointing.reference < e.start || e.pointing.reference > e.start + e.length))
    line.fail("reference_ns", "must be within the exposure");
  e.window = read_window(line, sensor->camera.optics);
  e.gain = line.get<int>("gain");
  e.offset = line.get<int>("offset");
  if (e.gain != 0) line.fail("gain", "must be 0: the camera has one gain");
  if (e.offset != 0) line.fail("offset", "must be 0: the camera has one offset");
  e.temperature_c = within(line, "temperature_c", -273.0, 100.0);
  read_light_path(line, *sensor, e);
  return e;
}

std::vector<CommandedExposure> read_night(const std::string& path, const Scenario& scenario) {
  std::vector<CommandedExposure> night;
  std::map<std::string, std::uint32_t> last;
  for_lines(path, {}, [&](const JsonRecord& line) {
    CommandedExposure e = read_commanded_exposure(line, scenario);
    if (const std::uint32_t next = ++last[e.sensor]; e.frame != next)
      line.fail("frame", "the next of " + e.sensor + " must be " + std::to_string(next));
    night.push_back(std::move(e));
  });
  return night;
}

SensorConfig commanded_sensor(const SensorConfig& sensor, const CommandedExposure& exposure) {
  SensorConfig s = sensor;
  const CommandedPointing& p = exposure.pointing;
  const bool moves = p.longitude_rate_deg_per_s != 0.0 || p.latitude_rate_deg_per_s != 0.0;
  if (p.follows) {
    // A pointing's rates are those since the start of the run.
    const double t_s = p.reference.seconds();
    s.pointing = PointSky{.ra_deg = p.longitude_deg - p.longitude_rate_deg_per_s * t_s,
                          .dec_deg = p.latitude_deg - p.latitude_rate_deg_per_s * t_s,
                          .ra_rate_deg_per_s = p.longitude_rate_deg_per_s,
                          .dec_rate_deg_per_s = p.latitude_rate_deg_per_s};
    s.tracking = moves ? Tracking::moving : Tracking::sidereal;
  } else {
    s.pointing = PointHorizon{.azimuth_deg = p.longitude_deg, .elevation_deg = p.latitude_deg};
    s.tracking = Tracking::fixed;
  }
  s.roll_deg = p.roll_deg;
  s.exposure_s = s.cadence_s = exposure.length.seconds();
  s.first_exposure_s = exposure.start.seconds();
  s.camera.detector.temperature_c = exposure.temperature_c;
  s.camera.dark = exposure.dark;
  return focused(std::move(s), exposure.focus_um, exposure.start + exposure.length);
}

bool is_within_run(const Scenario& scenario, const SensorConfig& sensor, const FrameTimes& times) {
  const ExposureSpan span = exposure_span(sensor, times);
  return span.start.ns >= 0 && span.end <= scenario.duration;
}

}  // namespace dmise
