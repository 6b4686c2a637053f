#pragma once
#include "core/materials/mesh.h"

// A part of a mesh, the triangles marked as its panel, that turns about a hinge to face the Sun.
namespace dmise {

/// How the panel turns: about the line through `hinge_m` along the hinge.
struct HingedPanel {
  SunTrackingPanel axes;
  Vec<Body> hinge_m;  // a point of the hinge

  bool operator==(const HingedPanel&) const = default;
};

bool has_panel(const Mesh& mesh);

/// Whether a facet of the panel at rest faces its normal, as stated, to 45 deg.
bool faces_normal(const Mesh& mesh, const SunTrackingPanel& panel);

/// Marks the vertices of the panel. `mesh` has none that its other facets share.
std::vector<bool> panel_vertices(const Mesh& mesh);

/// Gives the panel its own copies of the vertices that it shares with other facets.
void separate_panel(Mesh& mesh);

/// The rotation of the panel from rest with the Sun in this direction.
Rotation<Body, Body> panel_rotation(const SunTrackingPanel& panel, const Vec<Body>& sun_direction);

/// Rotates the panel about a line through `hinge_m`. Nothing stops it where it meets other parts.
void turn_panel(Mesh& mesh, const Vec<Body>& hinge_m, const Rotation<Body, Body>& rotation);

/// Greatest distance of a vertex from the origin of the body's axes at any angle of the panel [m].
double radius_m(const Mesh& mesh, const HingedPanel& panel);

}  // namespace dmise
