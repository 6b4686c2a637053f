#pragma once
#include "core/materials/panel.h"

// Generated meshes, centred on the origin of the body's axes, lengths in metres; sheets have a
// separate front and back. Throw `Error` for sizes <= 0.
namespace dmise {

/// A box with edges x, y, z.
Mesh box(const Vec<Body>& size_m, const Material& material);

/// A sheet that faces +z.
Mesh plate(double width_x_m, double width_y_m, const Material& front, const Material& back);

/// A sphere of 20 n^2 nearly equal facets with corners on it, n the largest that gives at most
/// `facets` (>= 20). Its cross-section is too small by about 4/facets.
Mesh sphere(double radius_m, std::size_t facets, const Material& material);

/// A closed cylinder about z of `sides` >= 3 flat sides with corners on it.
Mesh cylinder(double radius_m, double length_m, int sides, const Material& material);

/// A box with two wings along +y and -y that face +z: its panel, by default hinged about y through
/// the origin.
struct BoxWing {
  Vec<Body> body_m{1.8, 1.6, 2.0};
  double wing_length_m = 5.0;  // along y, of each
  double wing_width_m = 1.8;   // along x
  double gap_m = 0.5;          // between body and wing
};
Mesh box_wing(const BoxWing& size, const Material& body, const Material& wing_front,
              const Material& wing_back);
/// A box-wing with another material on the side of the body that faces +z.
Mesh box_wing(const BoxWing& size, const Material& body, const Material& wing_front,
              const Material& wing_back, const Material& body_z);

/// A flat chassis of 3.65 m2 that faces +z (the Earth in nadir attitude) with one array of 22 m2
/// that is perpendicular to it and faces +y: areas of the Starlink v1.5 models in Fankhauser, Tyson
/// & Askari 2023, "Satellite Optical Brightness". The array is its panel.
Mesh starlink_like(const Material& chassis, const Material& array_front,
                   const Material& array_back);
/// The hinge of its array: the edge at the chassis, along x.
HingedPanel starlink_like_panel();

}  // namespace dmise
