#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/files/read_progress.h"
#include "core/products/detection.h"
#include "core/products/track.h"
#include "core/products/truth.h"
#include "core/run/run_record.h"
#include "core/time/clock.h"
#include "core/wcs/wcs.h"

namespace dmise {

/// A frame, as its line in frames.jsonl reports it.
struct RunFrame {
  std::string sensor;
  std::uint32_t frame = 0;
  SimTime start, middle, end;                            // exposure, as the sensor believes
  Vec<Gcrs> sensor_position_m, sensor_velocity_m_per_s;  // at mid exposure
  double column_step_deg = 0.0, row_step_deg = 0.0;      // angle of a pixel at the reference
  double psf_fwhm_px = 0.0;
  double zero_point_mag = 0.0;
  std::optional<Wcs> wcs;  // as detection saw the image

  double exposure_s() const { return (end - start).seconds(); }
};

/// The products of a run that has ended, to be exported.
struct RunProducts {
  std::string directory;
  std::string software, digest;
  std::uint64_t seed = 0;
  Clock clock;
  std::vector<RunSensor> sensors;        // sites are on WGS 84, whatever the scenario's ellipsoid
  std::vector<RunFrame> frames;          // by time, sensor and index
  std::vector<Truth> truths;             // if they were asked for, in the same order
  std::vector<Detection> detections;     // by time, sensor and index
  std::vector<Track> tracks;             // by time and id
  std::vector<RunCatalogue> catalogues;  // in the scenario's order
  std::vector<RunObject> own_objects;    // in the scenario's order

  /// "2018-01-21T00:15:10.000000000Z"
  std::string utc(SimTime t) const;
  /// Throw `ConfigError` for what the run does not have.
  const RunSensor& sensor(const std::string& name) const;
  std::size_t index_of(const std::string& sensor, std::uint32_t number) const;  // in `frames`
  const RunFrame& frame(const std::string& sensor, std::uint32_t number) const {
    return frames[index_of(sensor, number)];
  }

  /// The latest state of each confirmed track, by its id.
  std::map<std::uint32_t, const Track*> confirmed_tracks() const;

  std::map<std::pair<std::string, std::uint32_t>, std::size_t> frame_index;
};

/// "TRACK 3", by which messages name a track.
std::string track_name(const Track& track);

/// Throws `ConfigError` if an earlier version wrote a line of truth without the object's state.
void require_states(const RunProducts& run, const Truth& truth);

/// What is read of a run.
struct WantedProducts {
  bool truth = false, detections = false, tracks = false;
  std::string sensor;  // only of this one; empty: of all
};

/// Reads run.json, frames.jsonl and what is wanted. Throws `ConfigError` "FILE:LINE: KEY: reason"
/// for a file that is missing or invalid, and for a sensor that the run does not have.
RunProducts read_products(const std::string& directory, const WantedProducts& wanted,
                          const ReadProgress& progress);

}  // namespace dmise
