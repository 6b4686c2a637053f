#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/exchange/run_products.h"

namespace dmise {

struct ExportRequest;

/// A state of an object, with its covariance where there is one.
struct EphemerisState {
  SimTime time;
  Vec<Gcrs> position_m, velocity_m_per_s;
  /// Lower triangle by rows of x, y, z and their rates [m^2, m^2/s, m^2/s^2].
  std::optional<std::array<double, 21>> covariance = {};
};

struct ObjectEphemeris {
  std::string name, id;
  std::vector<EphemerisState> states;  // at least one; times increase
};

/// A CCSDS Orbit Ephemeris Message (502.0-B-2) in KVN, in GCRF and UTC: a segment for each object.
/// No interpolation is recommended, for the states may lie far apart.
std::string oem_text(const RunProducts& run, const std::vector<ObjectEphemeris>& ephemerides);

/// True states of the objects in the sensors' frames at mid exposure, without those that a run of
/// an earlier version did not write.
std::vector<ObjectEphemeris> truth_ephemerides(const RunProducts& run);

/// States of confirmed tracks, with covariances, at the ticks at which they took detections, by the
/// id of the track.
std::map<std::uint32_t, ObjectEphemeris> track_ephemerides(const RunProducts& run);

/// The message of the one of these that is asked for. Throws `ConfigError` if it is empty, and for
/// truth without states.
std::string run_oem_text(const ExportRequest& request);

}  // namespace dmise
