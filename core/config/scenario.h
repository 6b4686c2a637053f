#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/sim_time.h"
#include "core/config/object_config.h"
#include "core/config/sky_config.h"
#include "core/detector/detector.h"
#include "core/effects/effects.h"
#include "core/optics/camera.h"
#include "core/optics/seeing.h"
#include "core/orbit/interpolation.h"
#include "core/photometry/band.h"

namespace dmise {

/// What a camera preset (launch/cameras/NAME.yaml) holds.
struct Camera {
  std::string name;
  Optics optics;
  Detector detector;
  Band band;
  std::vector<std::string> warnings = {};  // see `disproportions_of_camera`
};

/// A sensor on the ground.
struct SiteConfig {
  std::string name;
  double latitude_deg = 0.0;   // geodetic, [-90, 90]
  double longitude_deg = 0.0;  // east, [-180, 360)
  double height_m = 0.0;       // above the ellipsoid, [-500, 9000]
  Surroundings surroundings;   // the site's own; the sensor's come first
};

/// A sensor aboard an object, named by number or name.
struct PlatformConfig {
  std::string object;
  std::string where = {};  // `file:line:column: sensors[0].platform`, for messages
};

/// Where the boresight points. On the ground "up" is the zenith; in orbit away from the Earth.
struct PointUp {};
struct PointHorizon {
  double azimuth_deg = 0.0;  // from north through east; at the start of the run
  double elevation_deg = 0.0;
  double azimuth_rate_deg_per_s = 0.0, elevation_rate_deg_per_s = 0.0;
};
struct PointSky {
  double ra_deg = 0.0, dec_deg = 0.0;  // ICRS; at the start of the run
  double ra_rate_deg_per_s = 0.0, dec_rate_deg_per_s = 0.0;
};
struct PointTarget {
  std::string object;      // catalogue number or name
  bool geometric = false;  // at the straight line to it, not at the place where it is seen
  std::string where = {};  // `file:line:column: sensors[0].pointing.target`, for messages
};
/// Fixed to the body of the platform.
struct PointBody {
  Rotation<Body, CameraFrame> body_from_camera;
};
/// Turns evenly about an axis, which keeps to the stars or, with a start on the horizon's grid, to
/// the ground.
struct PointScan {
  std::variant<PointSky, PointHorizon> start;
  std::array<double, 3> axis{0, 0, 1};  // unit; GCRS axes, or east, north, up
  double rate_deg_per_s = 0.0;          // right-handed about it
};
using Pointing = std::variant<PointUp, PointHorizon, PointSky, PointTarget, PointBody, PointScan>;

/// What the camera does while the shutter is open.
enum class Tracking {
  fixed,     // turns with the Earth (ground), or keeps its attitude to the local vertical (orbit)
  sidereal,  // keeps its attitude to the stars
  target,    // follows the target
  moving,    // moves as its pointing does
};
/// "fixed", ... as in YAML and in frames.
const char* tracking_name(Tracking tracking);

struct SensorConfig {
  std::string name;
  std::string where = {};  // `file:line:column: sensors[0]`, for messages
  std::variant<SiteConfig, PlatformConfig> place;
  Camera camera;
  Pointing pointing;
  Tracking tracking = Tracking::fixed;
  double roll_deg = 0.0;  // turns the image's up (-y), which is north, or the zenith for a pointing
                          // on the horizon's grid, towards east (towards growing azimuth)
  double exposure_s = 0.0;
  double cadence_s = 0.0;
  double first_exposure_s = 0.0;  // after the start of the run
  SkyConfig sky;
  AtmosphereConfig atmosphere;         // of a sensor on the ground
  WeatherConfig weather;               // likewise
  std::optional<SensorSeeing> seeing;  // none: no turbulence
  double mask_deg = 0.0;  // least elevation for `dmise visible`, on the ground, [0, 89]
  EffectSet effects;
  bool detect = true;  // off: frames are reported, nothing is looked for in them
};

enum class OnSilentNode { fail, wait, drop, restart };

/// How often the environment is told [s]; rounded up to whole ticks.
struct EnvironmentConfig {
  double common_every_s = 0.0;  // Sun, Moon, Earth; 0: every tick
  double site_every_s = 60.0;   // weather of each site
};

struct NetworkConfig {
  int window_ticks = 4;
  OnSilentNode on_silent_node = OnSilentNode::fail;
  double silent_after_s = 5.0;
  double join_within_s = 30.0;
  int restarts = 5;        // of each node, under `restart`
  double real_time = 0.0;  // simulated seconds a second; 0: as fast as possible
};

/// What a sensor writes of every frame.
struct OutputConfig {
  bool fits = true;
  bool fits_rice = false;   // compressed without loss
  bool saturation = false;  // the pixels' flags, a second image in the FITS file
  bool png = true;
  bool truth = true;
  bool star_truth = false;  // frame-NNNNNN.stars.csv: every star drawn
  int preview_width_px = 1663;
  bool radiance_exr = false;  // frame-NNNNNN-radiance.exr
  int radiance_bands = 1;     // its channels: the band, or beside it so many parts of it
  // frame-NNNNNN-PLANE.fits: what the counts were drawn from.
  bool sources = false, background = false, noise = false;
  // Of cameras, platforms, own objects, Sun and Moon at every tick.
  bool positions_csv = false, positions_jsonl = false, positions_oem = false;
  bool positions() const { return positions_csv || positions_jsonl || positions_oem; }
};

/// A whole scenario, resolved: presets read, paths found, defaults filled in, everything checked.
struct Scenario {
  std::string path;
  std::string start_utc;  // ISO 8601
  SimTime duration;
  SimTime tick;
  HermiteOrder interpolation = HermiteOrder::cubic;  // of objects between ticks
  std::uint64_t seed = 1;
  std::string earth_orientation_path;  // IERS finals file, may be empty
  std::vector<ObjectSource> objects;   // catalogues
  std::vector<OwnObject> own_objects;  // the scenario's own
  std::string star_catalogue_path;     // empty: no stars
  std::string star_catalogue_named;
  std::string star_catalogue_where;  // `file:line:column: stars.catalogue`, for messages
  double faintest_star_mag = 9.5;
  std::vector<SensorConfig> sensors;
  EnvironmentConfig environment;
  NetworkConfig network;
  OutputConfig output;
  std::vector<std::string> warnings;  // what can be meant but hardly is; each names its place

  /// The last tick: the first at or after the end of the run.
  Tick last_tick() const { return (duration.ns + tick.ns - 1) / tick.ns; }
  SimTime time_of(Tick k) const { return {k * tick.ns}; }
};

/// Reads and checks a scenario. Throws `ConfigError` with `file:line:column: key: reason, got
/// value`.
Scenario load_scenario(const std::string& path);

/// What decides the products, in a fixed order: the same text gives the same bytes.
std::string physics_json(const Scenario& scenario);

const SensorConfig& sensor_named(const Scenario& scenario, const std::string& name);

}  // namespace dmise
