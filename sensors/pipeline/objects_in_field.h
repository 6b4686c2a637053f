#pragma once
#include <cstdint>
#include <set>
#include <vector>

#include "sensors/pipeline/object_shapes.h"
#include "sensors/pipeline/view.h"

namespace dmise {

/// Objects that the sensor's position or direction depends on. Throws `ConfigError` for one that is
/// not in the roster.
std::set<std::size_t> needed_objects(const SensorConfig& sensor, const ObjectRoster& roster);

/// Objects whose path over the exposure may touch the frame, also between its ends: distances from
/// the cone around the field and bounds on the speed, as `dmise visible` finds crossings. The
/// sensor's own platform is left out. With `shapes` an object counts as far as its shape reaches.
std::vector<std::size_t> objects_in_field(const View& view, const ObjectShapes* shapes = nullptr);

/// Places of the objects of catalogues at one time, for a coarse test at times around it.
struct RoughPlaces {
  SimTime time;
  Rotation<Gcrs, Teme> gcrs_from_teme;
  std::size_t count = 0;                             // objects of catalogues, the first ones
  std::vector<double> position_m, velocity_m_per_s;  // of SGP4: all x, all y, all z
  std::vector<std::uint8_t> code;
  double interpolation_error_m = 0.0;  // of the states that the exact test uses
};

/// Objects of catalogues that `objects_in_field` may find, in any order: all that it finds are
/// among them. `view` needs no states but those of platform and target.
std::vector<std::uint32_t> may_be_in_field(const View& view, const RoughPlaces& rough);

}  // namespace dmise
