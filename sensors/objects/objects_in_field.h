#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "sensors/objects/object_shapes.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Objects that the sensor's position or direction depends on. Throws `ConfigError` for one that is
/// not in the roster.
std::set<std::size_t> needed_objects(const SensorConfig& sensor, const ObjectRoster& roster);

/// Objects whose path over the exposure may touch the frame, also between its ends: distances from
/// the cone around the field and bounds on the speed, as `dmise visible` finds crossings. The
/// sensor's own platform is left out. With `shapes` an object counts as far as its shape reaches.
std::vector<std::size_t> objects_in_field(const View& view, const ObjectShapes* shapes = nullptr);

/// Objects of `RoughPlaces` that can come near a camera's field, however long an exposure at times
/// around it, as long as the camera stays within the stated limits.
struct Shortlist {
  Vec<Teme> observer_m, axis;
  double moved_m = 0.0, turned_rad = 0.0;  // limits of changes of these two
  double cos_half = 0.0, half_exposure_s = 0.0, turn_rad_per_s = 0.0,
         observer_speed_m_per_s = 0.0;  // limits
  struct Place {
    Vec<Teme> position_m, velocity_m_per_s;
    std::uint32_t object;
  };
  std::vector<Place> places;
  std::vector<std::uint32_t> without_place;
};

/// Places of the objects of catalogues at one time, for a coarse test at times around it.
struct RoughPlaces {
  SimTime time;
  Rotation<Gcrs, Teme> gcrs_from_teme;
  std::size_t count = 0;                             // objects of catalogues, the first ones
  std::vector<double> position_m, velocity_m_per_s;  // from SGP4: all x, all y, all z
  std::vector<std::uint8_t> code;
  double interpolation_error_m = 0.0;  // error of the states that the exact test uses
  double longest_s = 0.0;              // between `time` and an exposure's middle
  std::optional<Shortlist> shortlist;  // what this camera may see, made at need
};

/// Objects of catalogues that `objects_in_field` may find, in any order: all that it finds are
/// among them. `view` needs no states but those of platform and target.
std::vector<std::uint32_t> may_be_in_field(const View& view, RoughPlaces& rough);

}  // namespace dmise
