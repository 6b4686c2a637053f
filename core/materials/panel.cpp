#include "core/materials/panel.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace dmise {

bool has_panel(const Mesh& mesh) {
  return std::ranges::any_of(mesh.triangles, &Mesh::Triangle::panel);
}

bool faces_normal(const Mesh& mesh, const SunTrackingPanel& panel) {
  constexpr double min_cosine = 0.70710678118654752;
  const Vec<Body> normal = unit(panel.normal);
  return std::ranges::any_of(mesh.triangles, [&](const Mesh::Triangle& t) {
    const Vec<Body> twice = double_area_m2(mesh, t);
    return t.panel && dot(twice, normal) > min_cosine * norm(twice);
  });
}

std::vector<bool> panel_vertices(const Mesh& mesh) {
  std::vector<bool> marked(mesh.vertex_m.size());
  for (const auto& t : mesh.triangles)
    if (t.panel)
      for (const auto corner : t.corner) marked[corner] = true;
  return marked;
}

void separate_panel(Mesh& mesh) {
  std::vector<bool> of_others(mesh.vertex_m.size());
  for (const auto& t : mesh.triangles)
    if (!t.panel)
      for (const auto corner : t.corner) of_others[corner] = true;
  std::map<std::uint32_t, std::uint32_t> copy;
  for (auto& t : mesh.triangles) {
    if (!t.panel) continue;
    for (auto& corner : t.corner) {
      if (!of_others[corner]) continue;
      const auto [found, is_new] = copy.try_emplace(corner, std::uint32_t(mesh.vertex_m.size()));
      if (is_new) mesh.vertex_m.push_back(Vec<Body>(mesh.vertex_m[corner]));
      corner = found->second;
    }
  }
}

Rotation<Body, Body> panel_rotation(const SunTrackingPanel& panel, const Vec<Body>& sun_direction) {
  return body_from_panel(panel, sun_direction) * body_from_panel(panel, panel.normal).inverse();
}

void turn_panel(Mesh& mesh, const Vec<Body>& hinge_m, const Rotation<Body, Body>& rotation) {
  const std::vector<bool> turns = panel_vertices(mesh);
  for (std::size_t i = 0; i < turns.size(); ++i)
    if (turns[i]) mesh.vertex_m[i] = hinge_m + rotation * (mesh.vertex_m[i] - hinge_m);
}

double radius_m(const Mesh& mesh, const HingedPanel& panel) {
  const std::vector<bool> turns = panel_vertices(mesh);
  const Vec<Body> hinge = unit(panel.axes.hinge);
  double most = 0.0;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Vec<Body>& v = mesh.vertex_m[i];
    if (!turns[i]) {
      most = std::max(most, norm(v));
      continue;
    }
    // The farthest point of its circle about the hinge.
    const double along_m = dot(v, hinge);
    const Vec<Body> centre_m = panel.hinge_m + hinge * (along_m - dot(panel.hinge_m, hinge));
    most =
        std::max(most, std::hypot(along_m, norm(centre_m - hinge * along_m) + norm(v - centre_m)));
  }
  return most;
}

}  // namespace dmise
