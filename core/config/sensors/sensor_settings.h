#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/config/objects/earth_config.h"
#include "core/config/objects/sky_config.h"
#include "core/detector/detector.h"
#include "core/effects/accuracy.h"
#include "core/effects/effects.h"
#include "core/fusion/cue_settings.h"
#include "core/instrument/instrument.h"
#include "core/instrument/malfunction.h"
#include "core/optics/camera.h"
#include "core/optics/exclusion.h"
#include "core/optics/waves/seeing.h"
#include "core/orbit/attitude.h"
#include "core/photometry/band.h"
#include "core/photometry/magnitude_system.h"
#include "core/sky/bodies/earth_disc.h"

namespace dmise {

/// A filter of a camera's wheel, as the detector sees it.
struct Filter {
  Band band;
  MagnitudeScale magnitudes;
};

/// Content of a camera preset (launch/cameras/NAME.yaml).
struct Camera {
  std::string name;
  Optics optics;
  Detector detector;
  Band band;
  MagnitudeScale magnitudes;               // detections and PHOTZP are in it
  std::vector<std::string> warnings = {};  // see `unusual_camera_values`
  Exclusion exclusion = {};
  std::vector<Filter> filters = {};  // in the wheel after `band`: an observatory changes them
  bool dark = false;                 // its cover or shutter is closed: no light comes in
};

/// A sensor on the ground.
struct SiteConfig {
  std::string name;
  double latitude_deg = 0.0;   // geodetic, [-90, 90]
  double longitude_deg = 0.0;  // east, [-180, 360)
  double height_m = 0.0;       // above the ellipsoid, [-500, 9000]
  Surroundings surroundings;   // what is around the site; the sensor's take precedence
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
  double offset_x_deg = 0.0, offset_y_deg = 0.0;  // its image from the boresight, columns and rows
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
  /// The scenario's effects before the plan, for truth, if the sensor is planned.
  std::optional<EffectSet> unplanned = {};
  std::optional<double> synthetic_stars_to_v_mag =
      {};              // the scenario's; none: there are none; infinity: to each frame's limit
  bool detect = true;  // false: frames are reported without detection
  bool light_curves = false;  // whether detections of streaks have their light over time
  // A program of the user's detects in its frames.
  struct Detector {
    std::string node;   // its name in `nodes`
    std::string where;  // `file:line:column: key`, for messages
  };
  std::optional<Detector> detector = {};  // none: our own
  // A program of the user's observes in place of a camera, whose members are not used.
  struct Observing {
    std::string node;               // its name in `nodes`
    std::string where;              // `file:line:column: key`, for messages
    bool truth = false;             // it is told the states of all objects
    double half_angle_deg = 180.0;  // a cone about its boresight with this contains its field
  };
  std::optional<Observing> observing = {};     // none: a camera does
  std::vector<Malfunction> malfunctions = {};  // faults of its devices in an observatory
  RecordedPlans recorded_plans = {};  // from a run that is replayed; empty: frames are planned

  bool is_camera() const { return !observing; }
  /// The one of `nodes` whose program its process starts; empty: none.
  std::string started_node() const {
    return observing ? observing->node : detector ? detector->node : "";
  }
};

}  // namespace dmise
