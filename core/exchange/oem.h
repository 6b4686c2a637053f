#pragma once
#include <array>
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
  std::optional<std::array<double, 21>> covariance;
};

struct ObjectEphemeris {
  std::string name, id;
  std::vector<EphemerisState> states;  // at least one; times increase
};

/// A CCSDS Orbit Ephemeris Message (502.0-B-2) in KVN, in GCRF and UTC: a segment for each object.
/// No interpolation is recommended, for the states may lie far apart.
std::string oem_text(const RunProducts& run, const std::vector<ObjectEphemeris>& ephemerides);

/// True states of the objects in the sensors' frames at mid exposure. Throws `ConfigError` for a
/// run of a version that did not write them.
std::string truth_oem_text(const ExportRequest& request);

/// States of confirmed tracks, with covariances, at the ticks at which they took detections.
std::string track_oem_text(const ExportRequest& request);

/// The one of these that is asked for.
std::string run_oem_text(const ExportRequest& request);

}  // namespace dmise
