#include "core/facets/facet_shadow.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

/// Facets with a smaller cosine cast no shadow.
constexpr double min_cosine = 1e-9;

}  // namespace

std::array<Vec<Body>, 2> axes_across(const Vec<Body>& d) {
  const Vec<Body> away = std::abs(d.x) < 0.6 ? Vec<Body>{1, 0, 0} : Vec<Body>{0, 1, 0};
  const Vec<Body> u = unit(cross(away, d));
  return {u, cross(d, u)};
}

FacetShadow::FacetShadow(const Mesh& mesh, const Vec<Body>& direction)
    : mesh_(mesh), direction_(direction) {
  const auto [u, v] = axes_across(direction);
  const std::size_t count = mesh.triangles.size();
  std::vector<Vec<Body>> place(mesh.vertex_m.size());  // two across the direction, one along it
  for (std::size_t i = 0; i < place.size(); ++i) {
    const auto& p = mesh.vertex_m[i];
    place[i] = {dot(p, u), dot(p, v), dot(p, direction)};
    slack_m_ = std::max({slack_m_, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  slack_m_ *= 1e-7;
  cosine_.resize(count);
  box_.resize(count);
  constexpr double far = 1e300;
  Box all{far, far, -far, -far, 0, 0};
  for (std::size_t f = 0; f < count; ++f) {
    const auto& triangle = mesh.triangles[f];
    const Vec<Body> twice = double_area_m2(mesh, triangle);
    const double length = norm(twice);
    cosine_[f] = length > 0.0 ? dot(twice, direction) / length : 0.0;
    Box box{far, far, -far, -far, far, -far};
    for (const auto c : triangle.corner) {
      const auto& p = place[c];
      box = {std::min(box.u0, p.x), std::min(box.v0, p.y), std::max(box.u1, p.x),
             std::max(box.v1, p.y), std::min(box.w0, p.z), std::max(box.w1, p.z)};
    }
    box_[f] = box;
    all = {std::min(all.u0, box.u0),
           std::min(all.v0, box.v0),
           std::max(all.u1, box.u1),
           std::max(all.v1, box.v1),
           0,
           0};
  }
  side_ = std::clamp(int(std::sqrt(double(count))), 1, 512);
  u0_ = all.u0;
  v0_ = all.v0;
  per_u_ = all.u1 > all.u0 ? side_ / (all.u1 - all.u0) : 0.0;
  per_v_ = all.v1 > all.v0 ? side_ / (all.v1 - all.v0) : 0.0;
  // Count, then fill.
  cell_begin_.assign(std::size_t(side_) * std::size_t(side_) + 1, 0);
  const auto for_cells = [&](auto&& work) {
    for (std::size_t f = 0; f < count; ++f) {
      if (cosine_[f] <= min_cosine) continue;
      const auto [c0, r0, c1, r1] = cells_of(box_[f]);
      for (int r = r0; r <= r1; ++r)
        for (int c = c0; c <= c1; ++c)
          work(f, std::size_t(r) * std::size_t(side_) + std::size_t(c));
    }
  };
  for_cells([&](std::size_t, std::size_t cell) { ++cell_begin_[cell + 1]; });
  for (std::size_t i = 1; i < cell_begin_.size(); ++i) cell_begin_[i] += cell_begin_[i - 1];
  in_cell_.resize(cell_begin_.back());
  auto next = cell_begin_;
  for_cells([&](std::size_t f, std::size_t cell) { in_cell_[next[cell]++] = std::uint32_t(f); });
}

std::array<int, 4> FacetShadow::cells_of(const Box& box) const {
  const auto cell = [this](double x, double x0, double per) {
    return std::clamp(int((x - x0) * per), 0, side_ - 1);
  };
  return {cell(box.u0, u0_, per_u_), cell(box.v0, v0_, per_v_), cell(box.u1, u0_, per_u_),
          cell(box.v1, v0_, per_v_)};
}

bool FacetShadow::blocks(const Box& box, const Box& other) const {
  return other.w1 > box.w0 + slack_m_ && other.u1 > box.u0 && other.u0 < box.u1 &&
         other.v1 > box.v0 && other.v0 < box.v1;
}

/// Calls `work` once for each facet whose box is in front of that of `facet`, until it returns
/// false.
template <class Work>
void FacetShadow::for_blockers(std::size_t facet, Work&& work) const {
  const Box& box = box_[facet];
  const auto [c0, r0, c1, r1] = cells_of(box);
  for (int r = r0; r <= r1; ++r)
    for (int c = c0; c <= c1; ++c) {
      const std::size_t cell = std::size_t(r) * std::size_t(side_) + std::size_t(c);
      for (std::uint32_t i = cell_begin_[cell]; i < cell_begin_[cell + 1]; ++i) {
        const std::uint32_t other = in_cell_[i];
        if (other == facet || !blocks(box, box_[other])) continue;
        // A facet in several cells is visited in the first cell that both share.
        const auto [oc0, or0, oc1, or1] = cells_of(box_[other]);
        if (std::max(oc0, c0) != c || std::max(or0, r0) != r) continue;
        if (!work(other)) return;
      }
    }
}

bool FacetShadow::may_be_hidden(std::size_t facet) const {
  bool found = false;
  for_blockers(facet, [&](std::uint32_t) {
    found = true;
    return false;
  });
  return found;
}

void FacetShadow::cut(std::size_t facet, std::vector<FacetPiece>& pieces) const {
  if (cosine_[facet] <= min_cosine) return;
  const auto& corner = mesh_.triangles[facet].corner;
  const Vec<Body> origin = mesh_.vertex_m[corner[0]];
  const Vec<Body> e1 = mesh_.vertex_m[corner[1]] - origin, e2 = mesh_.vertex_m[corner[2]] - origin;
  const Vec<Body> twice = cross(e1, e2);
  const double length2 = dot(twice, twice);
  const Vec<Body> normal = twice / std::sqrt(length2);
  const Vec<Body> to_s = cross(e2, twice) / length2, to_t = cross(twice, e1) / length2;
  for_blockers(facet, [&](std::uint32_t other) {
    // The part of the blocker above this facet's plane, projected on it along the light.
    std::array<Vec<Body>, 3> p;
    std::array<double, 3> height;
    for (int i = 0; i < 3; ++i) {
      p[i] = mesh_.vertex_m[mesh_.triangles[other].corner[i]] - origin;
      height[i] = dot(p[i], normal) - slack_m_;
    }
    std::array<FacetPiece::Point, 4> hole;
    std::size_t corners = 0;
    const auto add = [&](const Vec<Body>& at) {
      const Vec<Body> thrown = at - direction_ * (dot(at, normal) / cosine_[facet]);
      hole[corners++] = {dot(thrown, to_s), dot(thrown, to_t)};
    };
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      if (height[i] > 0.0) add(p[i]);
      if ((height[i] > 0.0) != (height[j] > 0.0))
        add(p[i] + (p[j] - p[i]) * (height[i] / (height[i] - height[j])));
    }
    if (corners >= 3) subtract({hole.data(), corners}, pieces);
    return !pieces.empty();
  });
}

}  // namespace dmise
