#include "core/materials/mesh_repair.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "core/base/error.h"
#include "core/materials/panel.h"

namespace dmise {
namespace {

std::string facets_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " facet" : " facets");
}

bool has_area(const Mesh& mesh, const Mesh::Triangle& t) {
  const Vec<Body>&a = mesh.vertex_m[t.corner[0]], &b = mesh.vertex_m[t.corner[1]],
        &c = mesh.vertex_m[t.corner[2]];
  const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  return norm(double_area_m2(mesh, t)) > 1e-9 * longest;
}

void drop_empty(Mesh& mesh, MeshLines& lines, std::vector<std::string>& notes) {
  std::size_t kept = 0, first_dropped = mesh.triangles.size();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!has_area(mesh, mesh.triangles[i])) {
      if (first_dropped == mesh.triangles.size()) {
        first_dropped = i;
        notes.push_back(lines.of(i) + ": facet without area dropped");
      }
      continue;
    }
    mesh.triangles[kept] = mesh.triangles[i];
    lines.line[kept++] = lines.line[i];
  }
  const std::size_t dropped = mesh.triangles.size() - kept;
  if (dropped > 1) notes.back() += " (the first of " + std::to_string(dropped) + ")";
  mesh.triangles.resize(kept);
  lines.line.resize(kept);
  if (kept == 0) throw ConfigError(lines.file + ": no facet has an area");
}

/// For each vertex, the index of the first vertex of the same part, panel or not, at the same
/// position.
std::vector<std::uint32_t> welded(const Mesh& mesh) {
  std::map<std::tuple<bool, double, double, double>, std::uint32_t> seen;
  const std::vector<bool> of_panel = panel_vertices(mesh);
  std::vector<std::uint32_t> place(mesh.vertex_m.size());
  for (std::size_t i = 0; i < place.size(); ++i) {
    const auto& v = mesh.vertex_m[i];
    place[i] = seen.try_emplace({of_panel[i], v.x, v.y, v.z}, std::uint32_t(i)).first->second;
  }
  return place;
}

struct Edge {
  std::uint32_t low, high;
  std::uint32_t triangle;
  bool rising;  // the triangle runs from low to high

  bool same_place(const Edge& b) const { return low == b.low && high == b.high; }
};

std::vector<Edge> sorted_edges(const Mesh& mesh) {
  const auto place = welded(mesh);
  std::vector<Edge> edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto a = place[mesh.triangles[t].corner[k]];
      const auto b = place[mesh.triangles[t].corner[(k + 1) % 3]];
      edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return edges;
}

/// Surfaces as sets of triangles connected by edges that exactly two of them share.
struct Surfaces {
  std::vector<std::uint32_t> of;  // surface of each triangle, identified by one of its triangles
  struct Neighbour {
    std::uint32_t triangle;
    bool agrees;  // both have the same orientation
  };
  std::vector<std::vector<Neighbour>> neighbours;
  std::vector<bool> open;  // by surface

  explicit Surfaces(const Mesh& mesh) {
    const auto edges = sorted_edges(mesh);
    const std::size_t count = mesh.triangles.size();
    of.resize(count);
    std::iota(of.begin(), of.end(), 0u);
    neighbours.resize(count);
    open.assign(count, false);
    for_places(edges, [&](std::size_t begin, std::size_t end) {
      if (end - begin == 2) of[root(edges[begin].triangle)] = root(edges[begin + 1].triangle);
    });
    for (std::uint32_t t = 0; t < count; ++t) of[t] = root(t);
    for_places(edges, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) join(edges, begin, end, i);
    });
  }

 private:
  template <class Work>
  static void for_places(const std::vector<Edge>& edges, Work&& work) {
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
      while (end < edges.size() && edges[end].same_place(edges[begin])) ++end;
      work(begin, end);
    }
  }

  std::uint32_t root(std::uint32_t t) {
    while (of[t] != t) t = of[t] = of[of[t]];
    return t;
  }

  /// Finds the only other triangle of the same surface at this edge; the surface is open if there
  /// is none or more than one.
  void join(const std::vector<Edge>& edges, std::size_t begin, std::size_t end, std::size_t i) {
    constexpr std::size_t crowded = 64;  // more at one edge are not a solid
    const auto surface = of[edges[i].triangle];
    std::size_t others = 0, other = i;
    for (std::size_t j = begin; j < std::min(end, begin + crowded); ++j)
      if (j != i && of[edges[j].triangle] == surface) {
        ++others;
        other = j;
      }
    if (others != 1 || end - begin > crowded)
      open[surface] = true;
    else
      neighbours[edges[i].triangle].push_back(
          {edges[other].triangle, edges[i].rising != edges[other].rising});
  }
};

/// Orients the triangles of a closed surface like its first; false if impossible. `members` is set
/// to its triangles.
bool agree(const Surfaces& surfaces, std::uint32_t first, std::vector<signed char>& turned,
           std::vector<std::uint32_t>& members) {
  members.assign(1, first);
  turned[first] = 0;
  bool orientable = true;
  for (std::size_t i = 0; i < members.size(); ++i)
    for (const auto& next : surfaces.neighbours[members[i]]) {
      const auto wanted = static_cast<signed char>(turned[members[i]] ^ (next.agrees ? 0 : 1));
      if (turned[next.triangle] < 0) {
        turned[next.triangle] = wanted;
        members.push_back(next.triangle);
      } else if (turned[next.triangle] != wanted) {
        orientable = false;
      }
    }
  return orientable;
}

/// Six times the volume of a closed surface, relative to one of its points to avoid cancellation.
double six_volumes(const Mesh& mesh, const std::vector<std::uint32_t>& members) {
  const Vec<Body> from = mesh.vertex_m[mesh.triangles[members[0]].corner[0]];
  double sum = 0.0;
  for (const auto m : members) {
    const auto& c = mesh.triangles[m].corner;
    sum += dot(mesh.vertex_m[c[0]] - from,
               cross(mesh.vertex_m[c[1]] - from, mesh.vertex_m[c[2]] - from));
  }
  return sum;
}

}  // namespace

std::vector<std::string> repair(Mesh& mesh, MeshLines lines) {
  std::vector<std::string> notes;
  drop_empty(mesh, lines, notes);
  const Surfaces surfaces(mesh);
  const std::size_t count = mesh.triangles.size();
  std::vector<signed char> turned(count, -1);
  std::vector<bool> one_sided(count, false);  // by surface: it has no outside
  for (std::uint32_t t = 0; t < count; ++t) {
    const auto surface = surfaces.of[t];
    if (surfaces.open[surface] || turned[t] >= 0) continue;
    std::vector<std::uint32_t> members;
    if (!agree(surfaces, t, turned, members)) {
      one_sided[surface] = true;
      continue;
    }
    std::size_t changed = 0;
    for (const auto m : members)
      if (turned[m] == 1) {
        mesh.triangles[m].turn_over();
        ++changed;
      }
    if (six_volumes(mesh, members) < 0) {
      for (const auto m : members) mesh.triangles[m].turn_over();
      changed = members.size() - changed;
    }
    if (changed > 0)
      notes.push_back(lines.of(t) + ": closed surface of " + facets_text(members.size()) +
                      ": turned " + std::to_string(changed) + " to face outwards");
  }
  const auto is_sheet = [&](std::uint32_t t) {
    return surfaces.open[surfaces.of[t]] || one_sided[surfaces.of[t]];
  };
  std::map<std::uint32_t, std::pair<std::size_t, std::size_t>> sheets;  // first facet, how many
  for (std::uint32_t t = 0; t < count; ++t)
    if (is_sheet(t)) {
      ++sheets.try_emplace(surfaces.of[t], std::pair{std::size_t(t), std::size_t(0)})
            .first->second.second;
      mesh.triangles.push_back(mesh.triangles[t]);
      mesh.triangles.back().turn_over();
    }
  constexpr std::size_t max_notes = 20;
  std::size_t sheet_count = 0;
  for (const auto& [surface, sheet] : sheets)
    if (++sheet_count <= max_notes)
      notes.push_back(lines.of(sheet.first) + ": open surface of " + facets_text(sheet.second) +
                      ": a sheet, given a back");
  if (sheet_count > max_notes)
    notes.push_back(lines.file + ": and " + std::to_string(sheet_count - max_notes) +
                    " more open surfaces");
  return notes;
}

}  // namespace dmise
