#pragma once
#include "core/materials/mesh.h"

// Meshes that the project makes itself. All are centred on the origin of the body's axes, lengths
// in metres; sheets have a front and a back of their own. Sizes must be > 0: else `Error`.
namespace dmise {

/// Faces of a box of size x, y, z.
Mesh box(const Vec<Body>& size_m, const Material& material);

/// A sheet that faces +z.
Mesh plate(double width_x_m, double width_y_m, const Material& front, const Material& back);

/// A sphere of 20 n^2 nearly equal facets with corners on it, n the greatest for which there are no
/// more than `facets` (>= 20): its cross-section is smaller by about 4/facets.
Mesh sphere(double radius_m, std::size_t facets, const Material& material);

/// A closed cylinder about z of `sides` >= 3 flat sides with corners on it.
Mesh cylinder(double radius_m, double length_m, int sides, const Material& material);

/// A box and two wings along +y and -y that face +z.
struct BoxWing {
  Vec<Body> body_m{1.8, 1.6, 2.0};
  double wing_length_m = 5.0;  // along y, of each
  double wing_width_m = 1.8;   // along x
  double gap_m = 0.5;          // between body and wing
};
Mesh box_wing(const BoxWing& size, const Material& body, const Material& wing_front,
              const Material& wing_back);

/// A flat chassis of 3.65 m2 that faces +z (the Earth in nadir attitude) and one array of 22 m2
/// that stands on it and faces +y: areas of the Starlink v1.5 models in Fankhauser, Tyson & Askari
/// 2023, "Satellite Optical Brightness".
Mesh starlink_like(const Material& chassis, const Material& array_front,
                   const Material& array_back);

}  // namespace dmise
