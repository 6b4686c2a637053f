#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/sim_time.h"
#include "core/config/earth_config.h"
#include "core/config/object_config.h"
#include "core/config/own_node_config.h"
#include "core/config/sky_config.h"
#include "core/detector/detector.h"
#include "core/effects/accuracy.h"
#include "core/effects/effects.h"
#include "core/fusion/cue_settings.h"
#include "core/fusion/fusion_settings.h"
#include "core/instrument/instrument.h"
#include "core/optics/camera.h"
#include "core/optics/exclusion.h"
#include "core/optics/seeing.h"
#include "core/orbit/interpolation.h"
#include "core/photometry/band.h"
#include "core/photometry/magnitude_system.h"
#include "core/sky/earth_disc.h"

namespace dmise {

/// Content of a camera preset (launch/cameras/NAME.yaml).
struct Camera {
  std::string name;
  Optics optics;
  Detector detector;
  Band band;
  MagnitudeScale magnitudes;               // of detections and of PHOTZP
  std::vector<std::string> warnings = {};  // see `unusual_camera_values`
  Exclusion exclusion = {};
};

/// A sensor on the ground.
struct SiteConfig {
  std::string name;
  double latitude_deg = 0.0;   // geodetic, [-90, 90]
  double longitude_deg = 0.0;  // east, [-180, 360)
  double height_m = 0.0;       // above the ellipsoid, [-500, 9000]
  Surroundings surroundings;   // of the site; the sensor's take precedence
};

/// A sensor aboard an object, given by number or name.
struct PlatformConfig {
  std::string object;
  std::string where = {};  // `file:line:column: sensors[0].platform`, for messages
};

/// Boresight towards the zenith on the ground, away from the Earth in orbit.
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
  bool geometric = false;  // along the straight line, not the apparent direction
  double offset_x_deg = 0.0, offset_y_deg = 0.0;  // of its image from the boresight, along columns
                                                  // and rows
  std::string where = {};  // `file:line:column: sensors[0].pointing.target`, for messages
};
/// Fixed to the body of the platform.
struct PointBody {
  Rotation<Body, CameraFrame> body_from_camera;
};
/// In east, north and up of the scenario's origin, wherever the sensor is.
struct PointEnu {
  Site origin;
  std::optional<Vec<Enu>> at_m;  // a place to look at; none: along `look`
  Vec<Enu> look{0, 1, 0};        // unit
  Vec<Enu> up{0, 0, 1};          // unit, towards the image's top
  std::string where = {};        // `file:line:column: sensors[0].pointing.enu`, for messages
};
/// Rotates uniformly about an axis that is fixed relative to the stars or, for a start by azimuth
/// and elevation, to the ground.
struct PointScan {
  std::variant<PointSky, PointHorizon> start;
  std::array<double, 3> axis{0, 0, 1};  // unit; GCRS axes, or east, north, up
  double rate_deg_per_s = 0.0;          // right-handed about it
};
/// Towards what the fusion node tells it to observe; before its first task, and where there is no
/// fusion, at `park`.
struct PointCued {
  PointHorizon park{.azimuth_deg = 180.0, .elevation_deg = 60.0};
  CueSettings cue;
  std::string where = {};  // `file:line:column: sensors[0].pointing.cued`, for messages
};
using Pointing = std::variant<PointUp, PointHorizon, PointSky, PointTarget, PointBody, PointScan,
                              PointCued, PointEnu>;

/// Motion of the camera during an exposure.
enum class Tracking {
  fixed,     // relative to the Earth (ground) or the local vertical (orbit)
  sidereal,  // relative to the stars
  target,    // follows the target
  moving,    // follows the pointing
};
/// "fixed", ... as in YAML and in frames.
const char* tracking_name(Tracking tracking);

/// Names of the levels of effects by frame and name of the effect.
using RecordedPlans = std::map<std::uint32_t, std::map<std::string, std::string>>;

struct SensorConfig {
  std::string name;
  std::string where = {};  // `file:line:column: sensors[0]`, for messages
  std::variant<SiteConfig, PlatformConfig> place;
  Ellipsoid ellipsoid{};  // the scenario's Earth
  double earth_albedo = usual_earth_albedo;
  Camera camera;
  Pointing pointing;
  Tracking tracking = Tracking::fixed;
  double roll_deg = 0.0;  // rotates the image's up (-y), which is north, or zenith for a pointing
                          // by azimuth and elevation, towards east (increasing azimuth)
  double exposure_s = 0.0;
  double cadence_s = 0.0;
  double first_exposure_s = 0.0;  // after the start of the run
  SkyConfig sky;
  AtmosphereConfig atmosphere;         // on the ground
  WeatherConfig weather;               // on the ground
  std::optional<SensorSeeing> seeing;  // none: no turbulence
  Instrument instrument{};             // what it does not know of itself
  double mask_deg = 0.0;  // minimum elevation for `dmise visible`, on the ground, [0, 89]
  EffectSet effects;      // by the user; what a plan leaves to choose is as it is without a plan
  Accuracy accuracy{};    // what frames are planned for; none: effects run as above
  /// Of a sensor that is planned: effects of the scenario before the plan, for truth.
  std::optional<EffectSet> unplanned = {};
  std::optional<double> synthetic_stars_to_v_mag = {};  // the scenario's; none: there are none
  bool detect = true;  // false: frames are reported without detection
  // Of a program that detects in its frames.
  struct Detector {
    std::string node;   // of `nodes`
    std::string where;  // `file:line:column: key`, for messages
  };
  std::optional<Detector> detector = {};  // none: our own
  // Of a program that observes in place of a camera: the camera's members are not used.
  struct Observing {
    std::string node;               // of `nodes`
    std::string where;              // `file:line:column: key`, for messages
    bool truth = false;             // it is told the states of all objects
    double half_angle_deg = 180.0;  // of a cone about its boresight that contains its field
  };
  std::optional<Observing> observing = {};  // none: a camera does
  RecordedPlans recorded_plans = {};        // of a run that is replayed; empty: frames are planned

  bool is_camera() const { return !observing; }
  /// Of `nodes`, whose program its process starts; empty: none.
  std::string started_node() const {
    return observing ? observing->node : detector ? detector->node : "";
  }
};

enum class OnSilentNode { fail, wait, drop, restart };

/// Publication interval of the environment [s]; rounded up to whole ticks.
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
  double real_time = 0.0;  // simulated seconds per second; 0: as fast as possible
  // States are published for subscribers that are not nodes of the scenario as well.
  bool publish_states = true;
  // Sensors propagate the objects that may be in their field; false: they take published states.
  bool sensors_propagate = true;
};

/// Output files of every frame.
struct OutputConfig {
  bool fits = true;
  bool fits_rice = false;   // lossless compression
  bool saturation = false;  // pixel flags, a second image in the FITS file
  bool png = true;
  bool truth = true;
  bool star_truth = false;  // frame-NNNNNN.stars.csv: every star drawn
  int preview_width_px = 1663;
  bool radiance_exr = false;  // frame-NNNNNN-radiance.exr
  int radiance_bands = 1;     // channels: the band, and its parts if > 1
  // frame-NNNNNN-PLANE.fits: expectations that the counts were drawn from.
  bool sources = false, background = false, noise = false;
  // Positions of cameras, platforms, own objects, Sun and Moon at every tick.
  bool positions_csv = false, positions_jsonl = false, positions_oem = false;
  bool positions_enu = false;        // tables in east, north and up of the scenario's origin
  std::string positions_where = {};  // `file:line:column: output.positions_frame`, for messages
  bool positions() const { return positions_csv || positions_jsonl || positions_oem; }
};

/// Tracks from the detections of all sensors, by a node of its own.
struct FusionConfig {
  FusionSettings settings;
  std::string node;                           // that makes the tracks; empty: our own
  std::string node_where;                     // `file:line:column: fusion.node`, for messages
  Tick cue_delay_ticks = 2;                   // between the tick of a task and its beginning, >= 1
  std::vector<std::string> not_in_catalogue;  // names or numbers of objects that it does not know
  std::vector<std::string> not_in_catalogue_where = {};  // of each, for messages
  std::string where = {};                                // `file:line:column: fusion`
};

/// A complete scenario: presets read, paths resolved, defaults filled in, everything checked.
struct Scenario {
  std::string path;
  std::string start_utc;  // ISO 8601
  SimTime duration;
  SimTime tick;
  HermiteOrder interpolation = HermiteOrder::cubic;  // of objects between ticks
  std::uint64_t seed = 1;
  std::string earth_orientation_path;  // IERS finals file, may be empty
  EarthConfig earth;
  std::vector<ObjectSource> objects;   // catalogues
  std::vector<OwnObject> own_objects;  // defined by the scenario
  std::vector<OwnNode> own_nodes;      // programs of the user's
  std::string star_catalogue_path;     // empty: no stars
  std::string star_catalogue_named;
  std::string star_catalogue_where;  // `file:line:column: stars.catalogue`, for messages
  double faintest_star_mag = 9.5;
  std::optional<double> synthetic_stars_to_v_mag = {};  // none: there are none
  std::vector<SensorConfig> sensors;
  EnvironmentConfig environment;
  NetworkConfig network;
  OutputConfig output;
  std::optional<FusionConfig> fusion;  // none: no fusion node
  std::vector<std::string> warnings;   // unusual values; each names its key

  /// The last tick: the first at or after the end of the run.
  Tick last_tick() const { return (duration.ns + tick.ns - 1) / tick.ns; }
  SimTime time_of(Tick k) const { return {k * tick.ns}; }
  /// Whether nodes of the scenario need the states of objects published.
  bool nodes_take_states() const;
};

/// Reads and checks a scenario. Throws `ConfigError` with `file:line:column: key: reason, got
/// value`, also for a value that is a distribution: see `ScenarioDraws`.
Scenario load_scenario(const std::string& path);
/// The same for one that is parsed.
class YamlValue;
Scenario read_scenario(const YamlValue& root, OwnNodeModels models = OwnNodeModels::programs);

/// Canonical JSON of everything that determines the products: the same text gives the same bytes.
std::string physics_json(const Scenario& scenario);

/// Whether a sensor of the user's needs published states: for its truth, or for its platform.
bool takes_states(const SensorConfig& sensor);

/// Leaves the cameras of a scenario, for `who`, which needs one. Throws `ConfigError` if there is
/// none.
void keep_cameras(Scenario& scenario, const std::string& who);

/// Where a sensor on the ground is; nothing in orbit.
std::optional<Site> site_of(const SensorConfig& sensor);

const SensorConfig& sensor_named(const Scenario& scenario, const std::string& name);

}  // namespace dmise
