#include "core/materials/mesh.h"

#include <algorithm>
#include <cmath>

namespace dmise {

Vec<Body> double_area_m2(const Mesh& mesh, const Mesh::Triangle& t) {
  const Vec<Body>& a = mesh.vertex_m[t.corner[0]];
  return cross(mesh.vertex_m[t.corner[1]] - a, mesh.vertex_m[t.corner[2]] - a);
}

double surface_m2(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) sum += norm(double_area_m2(mesh, t)) / 2;
  return sum;
}

double radius_m(const Mesh& mesh) {
  double most = 0.0;
  for (const auto& v : mesh.vertex_m) most = std::max(most, dot(v, v));
  return std::sqrt(most);
}

bool is_convex(const Mesh& mesh) {
  const double slack = 1e-9 * radius_m(mesh);
  for (const auto& t : mesh.triangles) {
    const Vec<Body> normal = unit(double_area_m2(mesh, t));
    const double height = dot(normal, mesh.vertex_m[t.corner[0]]) + slack;
    for (const auto& v : mesh.vertex_m)
      if (dot(normal, v) > height) return false;
  }
  return true;
}

Mesh merged(const Mesh& a, const Mesh& b) {
  Mesh both = a;
  std::vector<std::uint32_t> material(b.materials.size());
  for (std::size_t i = 0; i < b.materials.size(); ++i) {
    const auto found = std::find(both.materials.begin(), both.materials.end(), b.materials[i]);
    material[i] = std::uint32_t(found - both.materials.begin());
    if (found == both.materials.end()) both.materials.push_back(b.materials[i]);
  }
  const auto first = std::uint32_t(a.vertex_m.size());
  both.vertex_m.insert(both.vertex_m.end(), b.vertex_m.begin(), b.vertex_m.end());
  for (Mesh::Triangle t : b.triangles) {
    for (auto& corner : t.corner) corner += first;
    t.material = material[t.material];
    both.triangles.push_back(t);
  }
  return both;
}

Mesh moved(Mesh mesh, const Vec<Body>& by_m) {
  for (auto& v : mesh.vertex_m) v += by_m;
  return mesh;
}

Mesh scaled(Mesh mesh, double factor) {
  for (auto& v : mesh.vertex_m) v = v * factor;
  for (auto& material : mesh.materials) material.height_m *= factor;
  return mesh;
}

Mesh reversed(Mesh mesh) {
  for (auto& t : mesh.triangles) t.turn_over();
  return mesh;
}

}  // namespace dmise
