#pragma once
#include <cstdint>
#include <vector>

namespace dmise {

/// What every candidate detects: the logarithm of the probability that it misses an object in a
/// night, 0 for one that it never sees. Candidates x (nights x objects), row-major.
struct SiteMisses {
  std::size_t sites = 0, cells = 0;  // cells: nights x objects
  int nights = 1;
  std::vector<double> log_miss;  // <= 0
  std::vector<double> always;    // cells: of sensors that are there in any case; empty: none

  double at(std::size_t site, std::size_t cell) const { return log_miss[site * cells + cell]; }
};

/// Expected number of objects detected a night by a set of sites.
double objects_detected(const SiteMisses& misses, const std::vector<std::size_t>& sites);

/// A choice of sites.
struct SiteChoice {
  std::vector<std::size_t> sites;  // in the order in which greedy search took them, moved ones
                                   // in place of those that they replace
  std::vector<double> detected;    // objects a night with the first 1, 2, .. sites of greedy search
  double greedy = 0.0;             // objects a night: after greedy search
  double best = 0.0;               // and after moves
  double none = 0.0;               // with only the sensors that are there in any case
  double bound = 0.0;              // no choice of as many sites detects more
  int moves = 0;                   // exchanges of a single site that helped
};

/// Chooses `count` (1..sites) of the candidates for the most objects detected a night: greedily,
/// then moves single sites until none helps. Expected detections are monotone and submodular in
/// the set of sites, so greedy search gains at least 1 - 1/e of what the best choice gains
/// (Nemhauser, Wolsey & Fisher 1978, Mathematical Programming 14, 265), and no choice has more than
/// any set's value plus the `count` greatest gains of single sites on top of it: `bound` is the
/// least of these over the sets met. Among equal candidates the first is taken.
SiteChoice choose_sites(const SiteMisses& misses, std::size_t count);

/// Share of the best choice's gain that greedy search reaches in any case: 1 - 1/e.
inline constexpr double greedy_guarantee = 0.63212055882855767;

}  // namespace dmise
