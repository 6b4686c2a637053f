#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/materials/mesh.h"

// What of each facet parallel light from one direction reaches past the other facets, by clipping
// polygons: exact for flat facets, up to rounding. The Sun is a point here: the half-shadow that
// its 0.27 deg of radius draw (5 mm a metre behind the edge) is left out.
namespace dmise {

/// A convex part of a facet in the facet's own coordinates: (0, 0), (1, 0), (0, 1) are its corners.
struct FacetPiece {
  struct Point {
    double s, t;
  };
  static constexpr int most_corners = 12;
  std::array<Point, most_corners> corner;
  int corners = 0;

  static FacetPiece whole() { return {{{{0, 0}, {1, 0}, {0, 1}}}, 3}; }
};

/// Share of the facet's area that a piece has.
double area_share(const FacetPiece& piece);

/// What of `pieces` lies outside the convex polygon `hole` (counter-clockwise), as convex pieces;
/// parts below 1e-12 of the facet are dropped.
void subtract(std::span<const FacetPiece::Point> hole, std::vector<FacetPiece>& pieces);

/// Facets that stand in the way of light along one direction, found by a grid across it. Of solids
/// and sheets with backs (mesh_repair.h) those that face the light are enough.
class FacetShadow {
 public:
  /// `direction`: unit, from the object to the source or to the viewer. The mesh must outlive it.
  FacetShadow(const Mesh& mesh, const Vec<Body>& direction);

  /// Cosine between the facet's normal and the direction.
  double cosine(std::size_t facet) const { return cosine_[facet]; }

  /// Cuts out of the pieces of `facet` what others hide. A facet that faces away is left alone.
  void cut(std::size_t facet, std::vector<FacetPiece>& pieces) const;

  /// Whether any other facet may stand in the way of this one.
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
  // Grid: facets that face the light by cell, in rows.
  double u0_ = 0.0, v0_ = 0.0, per_u_ = 0.0, per_v_ = 0.0;
  int side_ = 1;
  std::vector<std::uint32_t> cell_begin_, in_cell_;

  std::array<int, 4> cells_of(const Box& box) const;
};

}  // namespace dmise
