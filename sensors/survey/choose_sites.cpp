#include "sensors/survey/choose_sites.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/base/error.h"

namespace dmise {
namespace {

/// Gains below this share of the value are rounding.
constexpr double min_gain = 1e-12;

/// A set of sites with what it misses.
class Network {
 public:
  explicit Network(const SiteMisses& misses) : misses_(misses), log_miss_(misses.cells, 0.0) {
    if (!misses.always.empty()) log_miss_ = misses.always;
  }

  void add(std::size_t site) {
    for (std::size_t c = 0; c < misses_.cells; ++c) log_miss_[c] += misses_.at(site, c);
  }
  /// Objects detected a night.
  double value() const {
    double sum = 0.0;
    for (const double miss : log_miss_) sum -= std::expm1(miss);
    return sum / misses_.nights;
  }
  /// What `site` adds to it.
  double gain(std::size_t site) const {
    double sum = 0.0;
    for (std::size_t c = 0; c < misses_.cells; ++c)
      if (const double own = misses_.at(site, c); own < 0.0)
        sum -= std::exp(log_miss_[c]) * std::expm1(own);
    return sum / misses_.nights;
  }

 private:
  const SiteMisses& misses_;
  std::vector<double> log_miss_;
};

Network network_of(const SiteMisses& misses, const std::vector<std::size_t>& sites) {
  Network network(misses);
  std::vector<std::size_t> ascending = sites;
  std::sort(ascending.begin(), ascending.end());  // a fixed order of sums
  for (const std::size_t site : ascending) network.add(site);
  return network;
}

bool has(const std::vector<std::size_t>& sites, std::size_t site) {
  return std::find(sites.begin(), sites.end(), site) != sites.end();
}

/// The value of a set and the `count` greatest gains on top of it.
double bound_over(const SiteMisses& misses, const Network& network,
                  const std::vector<std::size_t>& sites, std::size_t count) {
  std::vector<double> gains;
  for (std::size_t s = 0; s < misses.sites; ++s)
    if (!has(sites, s)) gains.push_back(network.gain(s));
  std::sort(gains.begin(), gains.end(), std::greater<>());
  gains.resize(std::min(gains.size(), count));
  return std::accumulate(gains.begin(), gains.end(), network.value());
}

/// Replaces one site by the candidate that adds most, if that helps. Returns whether it did.
bool move_one(const SiteMisses& misses, SiteChoice& choice) {
  std::size_t from = choice.sites.size(), to = 0;
  double best = choice.best + min_gain * choice.best;
  for (std::size_t k = 0; k < choice.sites.size(); ++k) {
    std::vector<std::size_t> others = choice.sites;
    others.erase(others.begin() + std::ptrdiff_t(k));
    const Network network = network_of(misses, others);
    const double value = network.value();
    for (std::size_t s = 0; s < misses.sites; ++s) {
      if (has(choice.sites, s)) continue;
      if (const double with = value + network.gain(s); with > best) {
        best = with;
        from = k;
        to = s;
      }
    }
  }
  if (from == choice.sites.size()) return false;
  std::vector<std::size_t> moved = choice.sites;
  moved[from] = to;
  const double after = objects_detected(misses, moved);
  if (!(after > choice.best)) return false;
  choice.sites = std::move(moved);
  choice.best = after;
  return true;
}

}  // namespace

double objects_detected(const SiteMisses& misses, const std::vector<std::size_t>& sites) {
  return network_of(misses, sites).value();
}

SiteChoice choose_sites(const SiteMisses& misses, std::size_t count) {
  if (count < 1 || count > misses.sites)
    throw Error("choose_sites: must choose 1.." + std::to_string(misses.sites) + ", got " +
                std::to_string(count));
  SiteChoice choice;
  Network network(misses);
  choice.none = network.value();
  choice.bound = bound_over(misses, network, {}, count);
  while (choice.sites.size() < count) {
    std::size_t best = misses.sites;
    double most = -1.0;
    for (std::size_t s = 0; s < misses.sites; ++s) {
      if (has(choice.sites, s)) continue;
      if (const double gain = network.gain(s); gain > most) {
        most = gain;
        best = s;
      }
    }
    choice.sites.push_back(best);
    network.add(best);
    choice.detected.push_back(objects_detected(misses, choice.sites));
    choice.bound = std::min(choice.bound, bound_over(misses, network, choice.sites, count));
  }
  choice.greedy = choice.best = choice.detected.back();
  constexpr int max_moves = 1000;
  while (choice.moves < max_moves && move_one(misses, choice)) ++choice.moves;
  if (choice.moves > 0)
    choice.bound = std::min(
        choice.bound, bound_over(misses, network_of(misses, choice.sites), choice.sites, count));
  if (count == misses.sites) choice.bound = choice.best;
  choice.bound = std::max(choice.bound, choice.best);
  return choice;
}

}  // namespace dmise
