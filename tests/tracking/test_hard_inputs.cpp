#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/tracking/filter.h"
#include "core/tracking/initial/initial_orbit.h"
#include "core/tracking/initial/lambert.h"
#include "tests/support/tracking_trial.h"

namespace dmise {
namespace {

/// Numbers as broken senders have them.
class Rubbish {
 public:
  explicit Rubbish(std::uint64_t seed) : key_(rng_key(seed, "tracking", 0, "rubbish")) {}
  std::uint32_t word() { return rng_word(key_, count_++, 0); }
  double uniform() { return uniform_of(word()); }
  /// `good`, or something else once in `rarity`.
  double number(double good, unsigned rarity) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    const double others[] = {0, -0.0, NAN, inf, -inf, 1e-310, 1e300, -1e300, 1e20, -good, 1e-20};
    return word() % rarity ? good : others[word() % std::size(others)];
  }

 private:
  RngKey key_;
  std::uint32_t count_ = 0;
};

AngleObservation observation(Rubbish& dice, const AngleObservation& good, unsigned rarity) {
  AngleObservation out = good;
  for (double* x : {&out.sensor_m.x, &out.sensor_m.y, &out.sensor_m.z, &out.direction.x,
                    &out.direction.y, &out.direction.z, &out.covariance_rad2[0],
                    &out.covariance_rad2[1], &out.covariance_rad2[2]})
    *x = dice.number(*x, rarity);
  if (dice.word() % rarity == 0)
    out.time = SimTime{std::int64_t(dice.word()) * (dice.word() % 2 ? 1 : 1000)};
  if (dice.word() % rarity == 0)  // a direction of its own
    out.direction = from_spherical<Gcrs>(6.28 * dice.uniform(), 3 * dice.uniform() - 1.5);
  return out;
}

template <class T>
bool has_one(const Outcome<T>& outcome) {
  return bool(outcome) == outcome.reason.empty();
}

void expect_sane(const Outcome<BatchFit>& fit) {
  EXPECT_TRUE(has_one(fit));
  if (!fit) return;
  EXPECT_TRUE(is_sane(fit->estimate));
  EXPECT_TRUE(std::isfinite(fit->chi2));
}

// A value of finite numbers or one reason, whatever comes in.
TEST(HardInputs, GiveAValueOrAReason) {
  const ForceModel forces(ForceSettings{});
  TrialSettings settings;
  settings.exposures = 4;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    const TrackingTrial trial = tracking_trial(forces, settings, seed);
    Rubbish dice(seed);
    const unsigned rarity = 20 + seed % 200;
    std::vector<AngleObservation> seen;
    for (const AngleObservation& o : trial.observations)
      seen.push_back(observation(dice, o, rarity));
    const std::span<const AngleObservation> all = seen;
    for (const auto& pair : {all.first(2), all.subspan(2, 4), all.first(3)}) {
      const auto position = triangulate(pair);
      EXPECT_TRUE(has_one(position));
      if (position) {
        EXPECT_TRUE(std::isfinite(norm(position->position_m)));
        EXPECT_TRUE(position->covariance_m2.allFinite());
      }
    }
    const std::array three{seen[0], seen[3], seen[6]};
    for (const auto& orbits : {gauss_orbit(three), gooding_orbit(three)}) {
      EXPECT_TRUE(has_one(orbits));
      for (const OrbitState& state : orbits ? *orbits : std::vector<OrbitState>{})
        EXPECT_TRUE(is_sane(state));
    }
    expect_sane(two_site_orbit(forces, all));
    expect_sane(fit_orbit(forces, all, trial.truth));
    const auto tracklet = tracklet_of(std::array{seen[0], seen[3], seen[6], seen[9]});
    EXPECT_TRUE(has_one(tracklet));
    EXPECT_TRUE(!tracklet || has_one(admissible_region(*tracklet)));
  }
}

TEST(HardInputs, LeaveTheFilterFinite) {
  const ForceModel forces(ForceSettings{});
  int taken = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const TrackingTrial trial = tracking_trial(forces, {}, seed);
    Rubbish dice(seed);
    OrbitEstimate start{trial.truth};
    start.covariance.diagonal() << 1e6, 1e6, 1e6, 1, 1, 1, 0, 0;
    OrbitFilter filter(forces, start);
    for (const AngleObservation& o : trial.observations) {
      const auto found = filter.update(observation(dice, o, 30));
      EXPECT_TRUE(has_one(found));
      taken += bool(found);
      EXPECT_TRUE(is_sane(filter.estimate()));
    }
  }
  EXPECT_GT(taken, 1000);
}

TEST(HardInputs, TimesFarAwayAreRefused) {
  const ForceModel forces(ForceSettings{});
  const TrackingTrial trial = tracking_trial(forces, {}, 1);
  OrbitEstimate start{trial.truth};
  start.covariance.diagonal() << 1e6, 1e6, 1e6, 1, 1, 1, 0, 0;
  OrbitFilter filter(forces, start);
  AngleObservation late = trial.observations[9];
  late.time = sim_seconds(4 * 86400);
  EXPECT_EQ(filter.update(late).reason, "too long after what is known");
  for (const std::int64_t ns :
       {std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()}) {
    late.time = SimTime{ns};
    EXPECT_EQ(filter.update(late).reason, "the time is out of range");
  }
  late.time = sim_seconds(-1);
  EXPECT_EQ(filter.update(late).reason, "older than what is kept");
}

}  // namespace
}  // namespace dmise
