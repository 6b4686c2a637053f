#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "core/config/objects/earth_config.h"
#include "core/config/objects/object_config.h"
#include "core/config/objects/own_node_config.h"
#include "core/config/sensors/sensor_settings.h"
#include "core/fusion/fusion_settings.h"
#include "core/orbit/interpolation.h"

namespace dmise {

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
  int restarts = 5;        // limit for each node, under `restart`
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
  std::string node;          // that makes the tracks; empty: our own
  std::string node_where;    // `file:line:column: fusion.node`, for messages
  Tick cue_delay_ticks = 2;  // between the tick of a task and its beginning, >= 1
  // Element sets that it knows instead of those with which objects move, resolved; empty: none.
  std::string catalogue_path = {};
  std::string catalogue_where = {};           // `file:line:column: fusion.catalogue`, for messages
  std::optional<double> age_days = {};        // least age of these at the start of the run
  std::vector<std::string> not_in_catalogue;  // names or numbers of objects that it does not know
  std::vector<std::string> not_in_catalogue_where = {};  // place of each, for messages
  std::string where = {};                                // `file:line:column: fusion`
};

/// A complete scenario: presets read, paths resolved, defaults filled in, everything checked.
struct Scenario {
  std::string path;
  std::string start_utc;  // ISO 8601
  SimTime duration;
  SimTime tick;
  HermiteOrder interpolation = HermiteOrder::cubic;  // between the states of objects at ticks
  std::uint64_t seed = 1;
  std::string earth_orientation_path;  // IERS finals file, may be empty
  EarthConfig earth;
  std::vector<ObjectSource> objects;   // catalogues
  std::vector<OwnObject> own_objects;  // defined by the scenario
  std::vector<OwnNode> own_nodes;      // programs of the user's
  std::string star_catalogue_path;     // empty: no stars
  std::string star_catalogue_named;
  std::string star_catalogue_where;  // `file:line:column: stars.catalogue`, for messages
  std::string star_variables_path;   // catalogue of variable stars; empty: none
  std::string star_variables_where;  // `file:line:column: stars.variables`, for messages
  double faintest_star_mag = 9.5;
  std::optional<double> synthetic_stars_to_v_mag = {};  // none, or infinity: as above
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
/// Reads a scenario that is parsed.
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
