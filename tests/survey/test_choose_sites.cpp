#include "sensors/survey/choose_sites.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/base/error.h"

namespace dmise {
namespace {

/// Candidates that see random shares of the objects; `rough`: some certainly, some never.
SiteMisses random_misses(std::size_t sites, std::size_t cells, unsigned seed, bool rough = false) {
  std::mt19937 dice(seed);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  SiteMisses misses{.sites = sites, .cells = cells, .nights = 1};
  for (std::size_t k = 0; k < sites * cells; ++k) {
    const double p = even(dice);
    misses.log_miss.push_back(rough ? (p < 0.15 ? std::log(1e-9) : 0.0) : std::log1p(-p * p * p));
  }
  return misses;
}

/// The best of all choices of `count` sites.
double best_of_all(const SiteMisses& misses, std::size_t count) {
  std::vector<bool> chosen(misses.sites, false);
  std::fill(chosen.begin(), chosen.begin() + std::ptrdiff_t(count), true);
  double best = 0.0;
  do {
    std::vector<std::size_t> sites;
    for (std::size_t s = 0; s < misses.sites; ++s)
      if (chosen[s]) sites.push_back(s);
    best = std::max(best, objects_detected(misses, sites));
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return best;
}

// By hand: 1 - 0.5 x 0.8 of the first object and 1 - 1 x 0.1 of the second.
TEST(ChooseSites, DetectedIsOneMinusTheProductOfMisses) {
  const SiteMisses misses{
      .sites = 2, .cells = 2, .log_miss = {std::log(0.5), 0.0, std::log(0.8), std::log(0.1)}};
  EXPECT_NEAR(objects_detected(misses, {0, 1}), 0.6 + 0.9, 1e-12);
  EXPECT_NEAR(objects_detected(misses, {0}), 0.5, 1e-12);
  EXPECT_EQ(objects_detected(misses, {}), 0.0);
}

TEST(ChooseSites, ASiteAddedNeverDetectsLessAndAddsLessToMore) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const SiteMisses misses = random_misses(6, 40, seed, seed % 2 == 0);
    for (std::size_t s = 2; s < 6; ++s) {
      const double few = objects_detected(misses, {0}), more = objects_detected(misses, {0, 1});
      const double few_with = objects_detected(misses, {0, s});
      const double more_with = objects_detected(misses, {0, 1, s});
      EXPECT_GE(few_with, few);
      EXPECT_GE(more_with, more);
      EXPECT_LE(more_with - more, few_with - few + 1e-9) << "submodular";
    }
  }
}

TEST(ChooseSites, GreedySearchKeepsItsGuaranteeAndNoChoiceExceedsTheBound) {
  for (unsigned seed = 1; seed <= 40; ++seed)
    for (const std::size_t count : {1, 2, 3, 4}) {
      const SiteMisses misses = random_misses(8, 30, seed, seed % 2 == 0);
      const SiteChoice choice = choose_sites(misses, count);
      const double best = best_of_all(misses, count);
      EXPECT_GE(choice.greedy, greedy_guarantee * best);
      EXPECT_GE(choice.best, choice.greedy);
      EXPECT_LE(choice.best, best + 1e-9);
      EXPECT_GE(choice.bound, best - 1e-9);
      EXPECT_NEAR(choice.best, objects_detected(misses, choice.sites), 1e-9);
      EXPECT_EQ(choice.sites.size(), count);
    }
}

// Sites 0 and 1 cover two halves; site 2 a bit more than either, across both. Greedy search takes
// it first.
TEST(ChooseSites, MovesOfSingleSitesMendGreedySearch) {
  SiteMisses misses{.sites = 3, .cells = 12, .log_miss = std::vector<double>(36, 0.0)};
  const double sees = std::log(1e-9);
  for (std::size_t c = 0; c < 6; ++c) misses.log_miss[c] = sees;
  for (std::size_t c = 6; c < 12; ++c) misses.log_miss[12 + c] = sees;
  for (std::size_t c = 2; c < 9; ++c) misses.log_miss[24 + c] = sees;
  const SiteChoice choice = choose_sites(misses, 2);
  EXPECT_LT(choice.greedy, 11.5);
  EXPECT_NEAR(choice.best, 12.0, 1e-6);
  EXPECT_EQ(choice.moves, 1);
}

TEST(ChooseSites, SensorsThatAreThereInAnyCaseCount) {
  SiteMisses misses{.sites = 2, .cells = 2, .log_miss = {std::log(0.1), 0.0, 0.0, std::log(0.3)}};
  misses.always = {std::log(0.1), 0.0};
  const SiteChoice choice = choose_sites(misses, 1);
  EXPECT_EQ(choice.sites, std::vector<std::size_t>{1});  // the first object is known already
  EXPECT_NEAR(choice.none, 0.9, 1e-12);
  EXPECT_NEAR(choice.best, 0.9 + 0.7, 1e-12);
}

TEST(ChooseSites, AllOfThemOrMoreThanThereAre) {
  const SiteMisses misses = random_misses(5, 10, 3);
  const SiteChoice choice = choose_sites(misses, 5);
  EXPECT_EQ(choice.sites.size(), 5u);
  EXPECT_EQ(choice.bound, choice.best);
  EXPECT_THROW(choose_sites(misses, 6), Error);
  EXPECT_THROW(choose_sites(misses, 0), Error);
}

TEST(ChooseSites, OfEqualSitesTheFirstIsTakenAndNobodyMayDetectAnything) {
  SiteMisses same{.sites = 3, .cells = 4, .log_miss = std::vector<double>(12, std::log(0.5))};
  EXPECT_EQ(choose_sites(same, 2).sites, (std::vector<std::size_t>{0, 1}));
  SiteMisses blind{.sites = 3, .cells = 4, .log_miss = std::vector<double>(12, 0.0)};
  const SiteChoice choice = choose_sites(blind, 2);
  EXPECT_EQ(choice.best, 0.0);
  EXPECT_EQ(choice.bound, 0.0);
  SiteMisses nothing{.sites = 2, .cells = 0};
  EXPECT_EQ(choose_sites(nothing, 1).best, 0.0);
}

}  // namespace
}  // namespace dmise
