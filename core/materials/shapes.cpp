#include "core/materials/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

void require_size(double value, const char* what) {
  if (!(value > 0.0 && value <= 1e6))
    throw Error(std::string(what) + " must be > 0 and at most 1e6 m, got " + std::to_string(value));
}

void add_face(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({{a, b, c}});
  mesh.triangles.push_back({{a, c, d}});
}

/// The mesh as a panel.
Mesh as_panel(Mesh mesh) {
  for (auto& t : mesh.triangles) t.panel = true;
  return mesh;
}

constexpr double chassis_thickness_m = 0.2;
constexpr double array_edge_z_m = -chassis_thickness_m / 2 - 0.1;  // hinge of the array

/// Vertices of a geodesic sphere without duplicates.
class Geodesic {
 public:
  Geodesic(int frequency, double radius_m) : n_(frequency), radius_m_(radius_m) {}

  Mesh make() {
    const double t = (1.0 + std::sqrt(5.0)) / 2.0;
    const Vec<Body> v[12] = {{-1, t, 0}, {1, t, 0}, {-1, -t, 0}, {1, -t, 0},
                             {0, -1, t}, {0, 1, t}, {0, -1, -t}, {0, 1, -t},
                             {t, 0, -1}, {t, 0, 1}, {-t, 0, -1}, {-t, 0, 1}};
    constexpr int face[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (const auto& f : face)
      for (int i = 0; i < n_; ++i)
        for (int j = 0; i + j < n_; ++j) {
          // Corner (i, j): the weights n-i-j, i, j of the face's corners.
          const auto at = [&](int a, int b) {
            return vertex({std::pair{f[0], n_ - a - b}, std::pair{f[1], a}, std::pair{f[2], b}}, v);
          };
          mesh_.triangles.push_back({{at(i, j), at(i + 1, j), at(i, j + 1)}});
          if (i + j + 1 < n_)
            mesh_.triangles.push_back({{at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}});
        }
    return std::move(mesh_);
  }

 private:
  using Key = std::array<std::pair<int, int>, 3>;  // (icosahedron's corner, weight)

  std::uint32_t vertex(Key key, const Vec<Body>* v) {
    for (auto& [corner, weight] : key)
      if (weight == 0) corner = 0;
    std::sort(key.begin(), key.end());
    const auto [found, is_new] = seen_.try_emplace(key, std::uint32_t(mesh_.vertex_m.size()));
    if (is_new) {
      Vec<Body> sum;
      for (const auto& [corner, weight] : key) sum += v[corner] * weight;
      mesh_.vertex_m.push_back(unit(sum) * radius_m_);
    }
    return found->second;
  }

  int n_;
  double radius_m_;
  Mesh mesh_;
  std::map<Key, std::uint32_t> seen_;
};

}  // namespace

Mesh box(const Vec<Body>& size_m, const Material& material) {
  require_size(size_m.x, "box: size x");
  require_size(size_m.y, "box: size y");
  require_size(size_m.z, "box: size z");
  Mesh mesh{.materials = {material}};
  for (int i = 0; i < 8; ++i)
    mesh.vertex_m.push_back({(i & 1 ? 0.5 : -0.5) * size_m.x, (i & 2 ? 0.5 : -0.5) * size_m.y,
                             (i & 4 ? 0.5 : -0.5) * size_m.z});
  add_face(mesh, 0, 2, 3, 1);
  add_face(mesh, 4, 5, 7, 6);
  add_face(mesh, 0, 1, 5, 4);
  add_face(mesh, 2, 6, 7, 3);
  add_face(mesh, 0, 4, 6, 2);
  add_face(mesh, 1, 3, 7, 5);
  return mesh;
}

Mesh plate(double width_x_m, double width_y_m, const Material& front, const Material& back) {
  require_size(width_x_m, "plate: width x");
  require_size(width_y_m, "plate: width y");
  const double x = width_x_m / 2, y = width_y_m / 2;
  Mesh mesh{.vertex_m = {{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}}, .materials = {front}};
  add_face(mesh, 0, 1, 2, 3);
  Mesh behind = reversed(mesh);
  behind.materials = {back};
  return merged(mesh, behind);
}

Mesh sphere(double radius_m, std::size_t facets, const Material& material) {
  require_size(radius_m, "sphere: radius");
  if (facets < 20 || facets > 2'000'000)
    throw Error("sphere: facets must be from 20 to 2000000, got " + std::to_string(facets));
  int n = 1;
  while (20 * std::size_t(n + 1) * std::size_t(n + 1) <= facets) ++n;
  Mesh mesh = Geodesic(n, radius_m).make();
  mesh.materials = {material};
  return mesh;
}

Mesh cylinder(double radius_m, double length_m, int sides, const Material& material) {
  require_size(radius_m, "cylinder: radius");
  require_size(length_m, "cylinder: length");
  if (sides < 3 || sides > 100000)
    throw Error("cylinder: sides must be from 3 to 100000, got " + std::to_string(sides));
  Mesh mesh{.materials = {material}};
  const auto n = std::uint32_t(sides);
  for (std::uint32_t i = 0; i < n; ++i)
    for (const double z : {-length_m / 2, length_m / 2})
      mesh.vertex_m.push_back(
          {radius_m * std::cos(2 * pi * i / sides), radius_m * std::sin(2 * pi * i / sides), z});
  mesh.vertex_m.push_back({0, 0, -length_m / 2});
  mesh.vertex_m.push_back({0, 0, length_m / 2});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % n);
    add_face(mesh, a, b, b + 1, a + 1);
    mesh.triangles.push_back({{2 * n, b, a}});
    mesh.triangles.push_back({{2 * n + 1, a + 1, b + 1}});
  }
  return mesh;
}

Mesh box_wing(const BoxWing& size, const Material& body, const Material& wing_front,
              const Material& wing_back) {
  return box_wing(size, body, wing_front, wing_back, body);
}

Mesh box_wing(const BoxWing& size, const Material& body, const Material& wing_front,
              const Material& wing_back, const Material& body_z) {
  if (!(size.gap_m >= 0.0)) throw Error("box-wing: gap must be >= 0");
  Mesh bus = box(size.body_m, body);
  if (body_z != body) {
    bus.materials.push_back(body_z);
    for (const std::size_t facing_z : {2, 3}) bus.triangles[facing_z].material = 1;
  }
  const double away = size.body_m.y / 2 + size.gap_m + size.wing_length_m / 2;
  const Mesh wing = as_panel(plate(size.wing_width_m, size.wing_length_m, wing_front, wing_back));
  return merged(merged(bus, moved(wing, {0, away, 0})), moved(wing, {0, -away, 0}));
}

Mesh starlink_like(const Material& chassis, const Material& array_front,
                   const Material& array_back) {
  constexpr double length_m = 2.8, width_m = 3.65 / length_m;
  constexpr double array_width_m = 2.75, array_height_m = 22.0 / array_width_m;
  // A plate that faces +z, turned about x to face +y and stand along -z.
  Mesh array = as_panel(plate(array_width_m, array_height_m, array_front, array_back));
  for (auto& v : array.vertex_m) v = {v.x, v.z, -v.y};
  array = moved(array, {0, 0, array_edge_z_m - array_height_m / 2});
  return merged(box({length_m, width_m, chassis_thickness_m}, chassis), array);
}

HingedPanel starlink_like_panel() {
  return {.axes = {.hinge = {1, 0, 0}, .normal = {0, 1, 0}}, .hinge_m = {0, 0, array_edge_z_m}};
}

}  // namespace dmise
