#include "core/materials/mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dmise {
namespace {

/// Points in a tree of boxes, each halved along its longest side.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Vec<Body>> points) : points_(std::move(points)) {
    if (!points_.empty()) add(0, points_.size());
  }

  /// Whether a point is farther than `height` along `normal`.
  bool any_beyond(const Vec<Body>& normal, double height) const {
    return !boxes_.empty() && any_beyond(normal, height, 0);
  }

 private:
  static constexpr std::size_t leaf = 8;  // points
  struct Box {
    Vec<Body> low, high;
    std::size_t begin, end;       // range of its points
    std::size_t right_child = 0;  // the left one follows; 0: a leaf
  };

  std::size_t add(std::size_t begin, std::size_t end) {
    Box box{points_[begin], points_[begin], begin, end};
    for (std::size_t i = begin; i < end; ++i) {
      const Vec<Body>& p = points_[i];
      box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
      box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    }
    const std::size_t index = boxes_.size();
    boxes_.push_back(box);
    if (end - begin <= leaf) return index;
    const Vec<Body> size = box.high - box.low;
    const auto axis = size.x >= size.y && size.x >= size.z ? &Vec<Body>::x
                      : size.y >= size.z                   ? &Vec<Body>::y
                                                           : &Vec<Body>::z;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto first = points_.begin();
    std::nth_element(first + std::ptrdiff_t(begin), first + std::ptrdiff_t(middle),
                     first + std::ptrdiff_t(end),
                     [&](const Vec<Body>& a, const Vec<Body>& b) { return a.*axis < b.*axis; });
    add(begin, middle);
    const std::size_t right = add(middle, end);
    boxes_[index].right_child = right;
    return index;
  }

  bool any_beyond(const Vec<Body>& normal, double height, std::size_t index) const {
    const Box& box = boxes_[index];
    const Vec<Body> farthest{normal.x > 0.0 ? box.high.x : box.low.x,
                             normal.y > 0.0 ? box.high.y : box.low.y,
                             normal.z > 0.0 ? box.high.z : box.low.z};
    if (!(dot(normal, farthest) > height)) return false;
    if (box.right_child > 0)
      return any_beyond(normal, height, index + 1) || any_beyond(normal, height, box.right_child);
    for (std::size_t i = box.begin; i < box.end; ++i)
      if (dot(normal, points_[i]) > height) return true;
    return false;
  }

  std::vector<Vec<Body>> points_;
  std::vector<Box> boxes_;
};

}  // namespace

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
  const BoxTree vertices(mesh.vertex_m);
  for (const auto& t : mesh.triangles) {
    const Vec<Body> normal = unit(double_area_m2(mesh, t));
    const double height = dot(normal, mesh.vertex_m[t.corner[0]]) + slack;
    if (vertices.any_beyond(normal, height)) return false;
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
