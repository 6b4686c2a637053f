#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/files/json_record.h"
#include "core/base/sim_time.h"
#include "core/frames/geodesy.h"
#include "core/orbit/elements/elements.h"

namespace dmise {

/// A sensor of a run.
struct RunSensor {
  std::string name;
  std::optional<Site> site;  // if on the ground, over the scenario's ellipsoid
  std::string platform;      // if in orbit: the object that carries it
  std::string camera;        // its name; "node NAME" of a program of the user's
  double exposure_s = 0.0, cadence_s = 0.0;
  int columns = 0, rows = 0;  // 0 of a sensor without a camera
  double psf_sigma_px = 0.0;  // Gaussian nearest to the camera's PSF; 0 without a camera
  bool light_time = true;     // whether objects are seen where they were when the light left
  std::optional<JsonRecord> camera_keys;
};

/// A catalogue of a run.
struct RunCatalogue {
  std::string named;              // as in the scenario
  std::vector<std::string> only;  // numbers or names; empty: all
  std::string sha256;             // hash of its text; empty in runs of early versions
};

/// An object of the scenario itself.
struct RunObject {
  std::uint32_t catalogue_number = 0;
  std::optional<MeanElements> elements;  // if it moves by SGP4
};

/// Time that a node's process took.
struct RunNode {
  std::string name;
  double compute_s = 0.0, messaging_s = 0.0, waiting_s = 0.0, start_s = 0.0;
};

/// What run.json says. If the run has not ended, or was killed, it has no more than status, digest
/// and parts.
struct RunRecord {
  std::string path;
  std::string status, how, reason, software, digest;
  std::vector<std::string> dropped;  // nodes that the run went on without
  std::optional<double> wall_s;
  int parts = 1;  // in which the run was made
  std::vector<RunNode> nodes;
  // The scenario:
  std::uint64_t seed = 0;
  std::string start_utc, star_catalogue;
  SimTime duration, tick;
  std::vector<RunSensor> sensors;
  std::vector<RunCatalogue> catalogues;  // in the scenario's order
  std::vector<RunObject> own_objects;    // in the scenario's order
};

/// None where the directory has no run.json. Throws `ConfigError` "FILE: KEY: reason" for one that
/// is invalid.
std::optional<RunRecord> read_run_record(const std::string& directory);

/// That of a run with a scenario. Throws `ConfigError` if there is none, or it has not ended.
RunRecord ended_run_record(const std::string& directory);

/// Levels of the effects of planned frames, by sensor and frame. Throws `ConfigError` for a
/// run.json without frames.
using FrameLevels = std::map<std::uint32_t, std::map<std::string, std::string>>;
std::map<std::string, FrameLevels> read_planned_levels(const std::string& run_json);

}  // namespace dmise
