#include "core/base/numeric/assignment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

struct Edge {
  std::size_t column;
  double cost;
};

class Solver {
 public:
  /// Each row has a column of its own behind the others, at cost 0: no pair.
  Solver(std::size_t rows, std::size_t columns, std::vector<Pairing> pairs)
      : columns_(columns + rows),
        edges_(rows),
        row_of_(columns_, unassigned),
        column_of_(rows, unassigned),
        price_(columns_, 0.0),
        distance_(columns_, infinite),
        came_from_(columns_, unassigned) {
    std::ranges::sort(pairs, [](const Pairing& a, const Pairing& b) {
      return std::tie(a.row, a.column, a.cost) < std::tie(b.row, b.column, b.cost);
    });
    for (const Pairing& p : pairs) {
      auto& of_row = edges_[p.row];
      if (of_row.empty() || of_row.back().column != p.column) of_row.push_back({p.column, p.cost});
    }
    for (std::size_t row = 0; row < rows; ++row) edges_[row].push_back({columns + row, 0.0});
  }

  std::vector<std::size_t> solve() {
    for (std::size_t row = 0; row < edges_.size(); ++row) augment(row);
    return column_of_;
  }

 private:
  void relax(std::size_t row, double offset) {
    for (const Edge& e : edges_[row]) {
      const double d = e.cost - price_[e.column] + offset;
      if (!(d < distance_[e.column])) continue;
      if (distance_[e.column] == infinite) touched_.push_back(e.column);
      distance_[e.column] = d;
      came_from_[e.column] = row;
      queue_.push({d, e.column});
    }
  }

  /// The cheapest path from a free row to a free column; pairs along it are swapped.
  void augment(std::size_t free_row) {
    queue_ = {};
    touched_.clear();
    scanned_.clear();
    relax(free_row, 0.0);
    std::size_t end = unassigned;
    while (end == unassigned) {
      const auto [d, column] = queue_.top();
      queue_.pop();
      if (d > distance_[column]) continue;  // replaced by a shorter one
      const std::size_t row = row_of_[column];
      if (row == unassigned) {
        end = column;
        break;
      }
      scanned_.push_back(column);
      const auto own = std::ranges::find(edges_[row], column, &Edge::column);
      relax(row, d - (own->cost - price_[column]));
    }
    for (const std::size_t column : scanned_) price_[column] += distance_[column] - distance_[end];
    for (std::size_t column = end;;) {
      const std::size_t row = came_from_[column], next = column_of_[row];
      row_of_[column] = row;
      column_of_[row] = column;
      if (row == free_row) break;
      column = next;
    }
    for (const std::size_t column : touched_) distance_[column] = infinite;
  }

  using Reach = std::tuple<double, std::size_t>;
  std::size_t columns_;
  std::vector<std::vector<Edge>> edges_;
  std::vector<std::size_t> row_of_, column_of_;
  std::vector<double> price_, distance_;
  std::vector<std::size_t> came_from_, touched_, scanned_;
  std::priority_queue<Reach, std::vector<Reach>, std::greater<>> queue_;
};

}  // namespace

std::vector<std::size_t> assign(std::size_t rows, std::size_t columns,
                                std::span<const Pairing> pairs) {
  for (const Pairing& p : pairs) {
    if (p.row >= rows || p.column >= columns) throw Error("assign: a pair is out of range");
    if (!std::isfinite(p.cost)) throw Error("assign: a cost is not finite");
  }
  auto found = Solver(rows, columns, {pairs.begin(), pairs.end()}).solve();
  for (std::size_t& column : found)
    if (column >= columns) column = unassigned;
  return found;
}

}  // namespace dmise
