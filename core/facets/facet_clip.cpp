#include <cmath>

#include "core/facets/facet_shadow.h"

namespace dmise {
namespace {

using Point = FacetPiece::Point;

constexpr double min_share = 1e-12;
constexpr double touching = 1e-12;  // a point so near to an edge of the facet is on it

/// Distance of `p` to the left of the line from `a` along the unit direction (ds, dt).
struct Line {
  Point from;
  double ds, dt;
  bool has_direction;  // its ends are distinct

  Line(const Point& a, const Point& b) : from(a), ds(b.s - a.s), dt(b.t - a.t) {
    const double length = std::hypot(ds, dt);
    has_direction = length > 1e-11;
    if (has_direction) {
      ds /= length;
      dt /= length;
    }
  }
  double left(const Point& p) const { return ds * (p.t - from.t) - dt * (p.s - from.s); }
};

bool all_right_of(const Line& line, const Point* points, int count) {
  if (!line.has_direction) return false;
  for (int i = 0; i < count; ++i)
    if (line.left(points[i]) > touching) return false;
  return true;
}

bool apart(std::span<const Point> hole, const FacetPiece& piece) {
  const int n = int(hole.size());
  for (int i = 0; i < n; ++i)
    if (all_right_of({hole[i], hole[(i + 1) % n]}, piece.corner.data(), piece.corners)) return true;
  for (int i = 0; i < piece.corners; ++i)
    if (all_right_of({piece.corner[i], piece.corner[(i + 1) % piece.corners]}, hole.data(), n))
      return true;
  return false;
}

/// The part of a piece on one side of a line: left for sign 1, right for -1.
FacetPiece side(const FacetPiece& piece, const Line& line, double sign) {
  FacetPiece part;
  const auto add = [&](const Point& p) {
    if (part.corners < FacetPiece::max_corners) part.corner[part.corners++] = p;
  };
  for (int i = 0; i < piece.corners; ++i) {
    const Point &a = piece.corner[i], &b = piece.corner[(i + 1) % piece.corners];
    const double da = sign * line.left(a), db = sign * line.left(b);
    if (da >= 0.0) add(a);
    if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) {
      const double x = da / (da - db);
      add({a.s + x * (b.s - a.s), a.t + x * (b.t - a.t)});
    }
  }
  return part;
}

/// Appends a piece, halved first if it has no room for one more corner.
void add_piece(const FacetPiece& piece, std::vector<FacetPiece>& pieces) {
  if (area_share(piece) < min_share) return;
  if (piece.corners + 1 < FacetPiece::max_corners) {
    pieces.push_back(piece);
    return;
  }
  const int half = piece.corners / 2;
  FacetPiece first, second;
  for (int i = 0; i <= half; ++i) first.corner[first.corners++] = piece.corner[i];
  for (int i = half; i < piece.corners; ++i) second.corner[second.corners++] = piece.corner[i];
  second.corner[second.corners++] = piece.corner[0];
  pieces.push_back(first);
  pieces.push_back(second);
}

}  // namespace

double area_share(const FacetPiece& piece) {
  double sum = 0.0;
  const Point& o = piece.corner[0];
  for (int i = 1; i + 1 < piece.corners; ++i) {
    const Point &a = piece.corner[i], &b = piece.corner[i + 1];
    sum += (a.s - o.s) * (b.t - o.t) - (a.t - o.t) * (b.s - o.s);
  }
  return sum;
}

void subtract(std::span<const Point> hole, std::vector<FacetPiece>& pieces) {
  std::size_t kept = 0;
  std::vector<FacetPiece> cut;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (apart(hole, pieces[k])) {
      if (kept != k) pieces[kept] = pieces[k];
      ++kept;
      continue;
    }
    FacetPiece rest = pieces[k];
    for (std::size_t i = 0; i < hole.size() && rest.corners >= 3; ++i) {
      const Line edge(hole[i], hole[(i + 1) % hole.size()]);
      if (!edge.has_direction) continue;
      add_piece(side(rest, edge, -1.0), cut);
      rest = side(rest, edge, 1.0);
    }
  }
  pieces.resize(kept);
  pieces.insert(pieces.end(), cut.begin(), cut.end());
}

}  // namespace dmise
