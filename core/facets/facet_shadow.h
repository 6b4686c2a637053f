#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/materials/mesh.h"

// Visibility of facets in parallel light by clipping polygons against other facets: exact for flat
// facets, up to rounding. The Sun is a point here: the penumbra of its 0.27 deg radius (5 mm per
// metre behind the edge) is neglected.
namespace dmise {

/// Two unit vectors perpendicular to `direction` (unit) and to each other.
std::array<Vec<Body>, 2> axes_across(const Vec<Body>& direction);

/// A convex part of a facet in the facet's own coordinates: (0, 0), (1, 0), (0, 1) are its corners.
struct FacetPiece {
  struct Point {
    double s, t;
  };
  static constexpr int max_corners = 12;
  std::array<Point, max_corners> corner;
  int corners = 0;

  static FacetPiece whole() { return {{{{0, 0}, {1, 0}, {0, 1}}}, 3}; }
};

/// Area of a piece as a fraction of the facet's area.
double area_share(const FacetPiece& piece);

/// Subtracts the convex polygon `hole` (counter-clockwise) from `pieces`, leaving convex pieces;
/// pieces below 1e-12 of the facet are dropped.
void subtract(std::span<const FacetPiece::Point> hole, std::vector<FacetPiece>& pieces);

/// Facets that block light along one direction, found with a grid perpendicular to it. For solids
/// and sheets with backs (mesh_repair.h) the facets that face the light suffice.
class FacetShadow {
 public:
  /// `direction`: unit vector from the object to the source or viewer. The mesh must outlive this
  /// object.
  FacetShadow(const Mesh& mesh, const Vec<Body>& direction);

  /// Cosine between the facet's normal and the direction.
  double cosine(std::size_t facet) const { return cosine_[facet]; }

  /// Subtracts what other facets hide from the pieces of `facet`. Does nothing for a facet that
  /// faces away.
  void cut(std::size_t facet, std::vector<FacetPiece>& pieces) const;

  /// Whether another facet may block this one.
  bool may_be_hidden(std::size_t facet) const;

 private:
  struct Box {
    double u0, v0, u1, v1, w0, w1;  // across and along the direction
  };
  template <class Work>
  void for_blockers(std::size_t facet, Work&& work) const;
  bool blocks(const Box& box, const Box& other) const;

  const Mesh& mesh_;
  Vec<Body> direction_;
  double slack_m_ = 0.0;
  std::vector<double> cosine_;
  std::vector<Box> box_;
  // Grid: facets facing the light, by cell, in rows.
  double u0_ = 0.0, v0_ = 0.0, per_u_ = 0.0, per_v_ = 0.0;
  int side_ = 1;
  std::vector<std::uint32_t> cell_begin_, in_cell_;

  std::array<int, 4> cells_of(const Box& box) const;
};

}  // namespace dmise
