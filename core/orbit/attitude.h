#pragma once
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "core/frames/quaternion.h"
#include "core/frames/vec.h"
#include "core/orbit/torque_free.h"

namespace dmise {

struct Panel {};  // axes of a panel: z its normal, x its hinge

/// z to the Earth's centre, y against the orbit's normal, x forward (the local orbital frame).
struct NadirAttitude {};

/// z to the Earth's centre, rotated about it so that y, the hinge of the panels, is perpendicular
/// to the Sun.
struct SunYawAttitude {};

/// Fixed relative to the stars.
struct InertialAttitude {
  Rotation<Gcrs, Body> gcrs_from_body;
};

/// Rotates uniformly about an axis that is fixed in the body and relative to the stars.
struct SpinningAttitude {
  Rotation<Gcrs, Body> gcrs_from_body;  // at time 0
  Vec<Body> axis{0.0, 0.0, 1.0};        // any length > 0
  double rate_rad_per_s = 0.0;          // right-handed about the axis
};

/// Turns freely: a rigid body on which no torque acts.
struct TumblingAttitude {
  Rotation<Gcrs, Body> gcrs_from_body;  // at time 0
  TorqueFreeRotation rotation;
};

/// Great-circle interpolation between attitudes at increasing times.
struct TableAttitude {
  std::vector<double> time_s;
  std::vector<Quaternion> gcrs_from_body;
};

/// As a node of the scenario says, tick by tick.
struct NodeAttitude {
  std::string node;
  std::size_t place = 0;  // index among the objects of the node
};

/// To add a model: list it here, give it an overload in attitude.cpp, test it in tests/orbit.
using Attitude = std::variant<NadirAttitude, SunYawAttitude, InertialAttitude, SpinningAttitude,
                              TumblingAttitude, TableAttitude, NodeAttitude>;

/// Inputs of an attitude model.
struct AttitudeScene {
  double time_s = 0.0;   // since the run's start
  Vec<Gcrs> position_m;  // geocentric
  Vec<Gcrs> velocity_m_per_s;
  Vec<Gcrs> sun_m;  // geocentric
};

/// Returns the attitude of a body. If a direction does not define an axis (vertical motion, the Sun
/// at the zenith) another axis is substituted, so that the result is always a rotation. Throws
/// `Error` for a zero position, a zero axis, and a time outside a table.
Rotation<Gcrs, Body> gcrs_from_body(const Attitude& attitude, const AttitudeScene& scene);

/// A flat panel that rotates about a hinge to face the Sun as well as possible.
struct SunTrackingPanel {
  Vec<Body> hinge{0.0, 1.0, 0.0};
  Vec<Body> normal{0.0, 0.0, 1.0};  // at angle 0; its part along the hinge is left out

  bool operator==(const SunTrackingPanel&) const = default;
};

/// Right-handed angle about the hinge [rad, -pi..pi] at which the normal is closest to
/// `sun_direction`; 0 if the Sun is along the hinge.
double panel_angle_rad(const SunTrackingPanel& panel, const Vec<Body>& sun_direction);

/// Axes of the panel at that angle.
Rotation<Body, Panel> body_from_panel(const SunTrackingPanel& panel,
                                      const Vec<Body>& sun_direction);

}  // namespace dmise
