#include "core/visibility/passes.h"

#include <algorithm>
#include <span>

#include "core/base/units.h"
#include "core/orbit/sgp4/synthetic_catalogue.h"
#include "tests/visibility/watch.h"

namespace dmise {
namespace {

using test::Watch;

struct SkyfieldPass {
  std::uint32_t number;
  double rise_s, top_s, set_s, elevation_rad, azimuth_rad, range_m, rate_rad_per_s, shadow_s;
  bool lit_at_rise;
};
// tests/reference/passes.py: find_events of skyfield 1.45 at 10 deg over Atlanta, 2018-01-21.
constexpr SkyfieldPass skyfield[] = {
#include "tests/visibility/passes_reference.inc"
};
// Passes over the day after a leap second, by skyfield too, with elements from before it.
constexpr SkyfieldPass after_leap_second[] = {
#include "tests/visibility/passes_after_leap_second.inc"
};

class AgainstSkyfield : public testing::Test {
 protected:
  struct Pair {
    SkyfieldPass theirs;
    Pass ours;
  };
  void SetUp() override { match(skyfield, "2018-01-21T00:00:00Z"); }
  void match(std::span<const SkyfieldPass> theirs, const std::string& start,
             const std::string& epoch = "") {
    std::vector<MeanElements> elements;
    for (const MeanElements& e : test::debian_catalogue())
      for (const SkyfieldPass& s : theirs)
        if (e.catalogue_number == s.number) {
          elements.push_back(e);
          break;
        }
    for (MeanElements& e : elements)
      if (!epoch.empty()) e.epoch_jd1 = parse_utc(epoch).jd1, e.epoch_jd2 = parse_utc(epoch).jd2;
    Watch watch(test::at_atlanta(test::all_sky_camera(), 10.0), elements, start, 86400, 10);
    passes = watch.passes();
    for (const SkyfieldPass& s : theirs) {
      const auto found = std::find_if(passes.begin(), passes.end(), [&](const Pass& p) {
        return elements[p.object].catalogue_number == s.number &&
               std::abs(p.top.time.seconds() - s.top_s) < 60;
      });
      ASSERT_NE(found, passes.end()) << s.number << " at " << s.top_s;
      pairs.push_back({s, *found});
    }
  }
  /// Returns the worst difference [s].
  double expect_rises_and_sets() const {
    double worst_s = 0;
    for (const auto& [theirs, ours] : pairs) {
      EXPECT_NEAR(ours.rise.time.seconds(), theirs.rise_s, 0.1) << theirs.number;
      EXPECT_NEAR(ours.set.time.seconds(), theirs.set_s, 0.1) << theirs.number;
      worst_s = std::max({worst_s, std::abs(ours.rise.time.seconds() - theirs.rise_s),
                          std::abs(ours.set.time.seconds() - theirs.set_s)});
    }
    return worst_s;
  }
  std::vector<Pass> passes;
  std::vector<Pair> pairs;
};

class AfterALeapSecond : public AgainstSkyfield {
 protected:
  void SetUp() override {
    match(after_leap_second, "2017-01-01T00:00:00Z", "2016-12-31T06:00:00Z");
  }
};

TEST_F(AgainstSkyfield, RiseAndSetAgreeWithinATenthOfASecond) {
  RecordProperty("worst_s", std::to_string(expect_rises_and_sets()));
}

TEST_F(AfterALeapSecond, RiseAndSetAgreeWithinATenthOfASecond) {
  RecordProperty("worst_s", std::to_string(expect_rises_and_sets()));
}

TEST_F(AgainstSkyfield, CulminationAgrees) {
  for (const auto& [theirs, ours] : pairs) {
    const bool high_orbit = theirs.range_m > 1e7;  // a flat maximum
    EXPECT_NEAR(ours.top.time.seconds(), theirs.top_s, high_orbit ? 1.0 : 0.2) << theirs.number;
    EXPECT_NEAR(ours.top.horizontal->elevation_rad, theirs.elevation_rad, 2e-5);
    EXPECT_NEAR(ours.top.range_m, theirs.range_m, high_orbit ? 500.0 : 200.0);
    const double azimuth =
        std::remainder(ours.top.horizontal->azimuth_rad - theirs.azimuth_rad, 2 * pi);
    // A tenth of a second near the zenith turns the azimuth by degrees.
    EXPECT_LT(std::abs(azimuth) * std::cos(theirs.elevation_rad), 2.5e-3) << theirs.number;
  }
}

// The camera looks at the zenith and stands on the ground: its frame's rate is that in the axes of
// the horizon.
TEST_F(AgainstSkyfield, TheRateAtTheCulminationAgrees) {
  double worst = 0;
  for (const auto& [theirs, ours] : pairs) {
    EXPECT_NEAR(ours.top.rate_rad_per_s / theirs.rate_rad_per_s, 1.0, 1e-3) << theirs.number;
    worst = std::max(worst, std::abs(ours.top.rate_rad_per_s / theirs.rate_rad_per_s - 1.0));
  }
  RecordProperty("worst", std::to_string(worst));
}

// No pass that they don't know: the same number for each object, those cut by the span aside.
TEST_F(AgainstSkyfield, TheNumberOfPassesAgrees) {
  std::size_t whole = 0;
  for (const Pass& p : passes) whole += !p.open_start && !p.open_end;
  EXPECT_EQ(whole, std::size(skyfield));
}

// Skyfield's Earth is a sphere of the equatorial radius and its Sun a point: half the disc is gone
// at most 21 km of Earth's radius, or a few seconds, from there.
TEST_F(AgainstSkyfield, LightAndShadowAgreeWithinTheModels) {
  int changes = 0;
  for (const auto& [theirs, ours] : pairs) {
    EXPECT_EQ(ours.rise.sunlit >= lit_fraction, theirs.lit_at_rise) << theirs.number;
    if (theirs.shadow_s < 0) {
      const double lit_s = theirs.lit_at_rise ? (ours.set.time - ours.rise.time).seconds() : 0.0;
      EXPECT_NEAR(ours.lit_s, lit_s, 8.0) << theirs.number << " at " << theirs.rise_s;
      continue;
    }
    ++changes;
    ASSERT_TRUE(ours.lit_from && ours.lit_to);
    const SimTime change = theirs.lit_at_rise ? *ours.lit_to : *ours.lit_from;
    EXPECT_NEAR(change.seconds(), theirs.shadow_s, 8.0) << theirs.number;
  }
  EXPECT_GE(changes, 3);
}

TEST(Passes, AGeostationaryObjectIsOneOpenPass) {
  MeanElements geo = synthetic_catalogue({.objects = 4, .seed = 1})[3];
  geo.inclination_rad = 0.001;
  geo.eccentricity = 1e-4;
  // Its mean longitude over Atlanta's meridian: tried all round.
  for (int k = 0; k < 24; ++k) {
    geo.mean_anomaly_rad = k * 2 * pi / 24;
    Watch watch(test::at_atlanta(test::all_sky_camera(), 20.0), {geo}, "2018-01-20T00:00:00Z",
                86400, 60);
    const auto passes = watch.passes();
    if (passes.empty()) continue;
    ASSERT_EQ(passes.size(), 1u);
    if (!passes[0].open_start || !passes[0].open_end) continue;
    EXPECT_EQ(passes[0].rise.time.ns, 0);
    EXPECT_EQ(passes[0].set.time, watch.grid.last());
    EXPECT_GT(passes[0].min_range_m, 35.7e6);
    EXPECT_GT(passes[0].lit_s, 0.94 * 86400);
    EXPECT_LT(passes[0].top.rate_rad_per_s, 1e-6);  // it stands in the frame
    return;
  }
  FAIL() << "no longitude is in sight all day";
}

// A field of 3 deg, instants a minute apart: in for a second or two, out at both.
TEST(Passes, AFastCrosserOutsideAtBothInstantsHasItsTimesToATenthOfASecond) {
  const auto sensor = test::at_atlanta(test::flat_camera(3, 3));
  const auto elements = synthetic_catalogue({.objects = 6000, .seed = 1});
  Watch coarse(sensor, elements, "2018-01-20T06:00:00Z", 2400, 60);
  Watch fine(sensor, elements, "2018-01-20T06:00:00Z", 2400, 0.25);
  int crossings = 0;
  const auto reference = fine.one_by_one();
  for (const Pass& p : coarse.passes()) {
    if (p.set.time - p.rise.time > sim_seconds(50)) continue;
    double first = 1e9, last = -1e9;
    for (const Sighting& s : reference.seen) {
      const double t = fine.grid.at(s.step).seconds();
      if (s.object != p.object || std::abs(t - p.top.time.seconds()) > 60) continue;
      first = std::min(first, t);
      last = std::max(last, t);
    }
    if (first > 1e8) {  // shorter than the fine grid's step
      EXPECT_LT((p.set.time - p.rise.time).seconds(), 0.25);
      continue;
    }
    EXPECT_NEAR(p.rise.time.seconds(), first - 0.125, 0.135) << p.object;
    EXPECT_NEAR(p.set.time.seconds(), last + 0.125, 0.135) << p.object;
    ++crossings;
  }
  EXPECT_GE(crossings, 5);
}

TEST(Passes, AzimuthRunsThroughNorthWithoutAJumpInTheTimes) {
  // Tilted to the north, where azimuth wraps from 360 to 0 deg.
  SensorConfig sensor = test::at_atlanta(test::flat_camera(40, 40));
  sensor.pointing = PointHorizon{.azimuth_deg = 0, .elevation_deg = 40};
  Watch watch(sensor, synthetic_catalogue({.objects = 1500, .seed = 1}), "2018-01-20T06:00:00Z",
              7200, 10);
  int through = 0;
  for (const Pass& p : watch.passes()) {
    const double a = p.rise.horizontal->azimuth_rad, b = p.set.horizontal->azimuth_rad;
    for (const double azimuth : {a, b}) {
      EXPECT_GE(azimuth, 0.0);
      EXPECT_LT(azimuth, 2 * pi);
    }
    through += std::abs(a - b) > pi;
    EXPECT_LE(p.rise.time, p.top.time);
    EXPECT_LE(p.top.time, p.set.time);
  }
  EXPECT_GE(through, 5);
}

// astropy 5.2.1, get_sun in AltAz without air and with UT1 = UTC: -0.8599 deg (its Sun is the
// apparent one, 20 arcsec from the geometric).
TEST(Passes, TheSunsElevationAtTheSiteIsTold) {
  MeanElements geo = synthetic_catalogue({.objects = 4, .seed = 1})[3];
  for (int k = 0; k < 24; ++k) {
    geo.mean_anomaly_rad = k * 2 * pi / 24;
    Watch watch(test::at_atlanta(test::all_sky_camera()), {geo}, "2018-01-20T22:57:00Z", 60, 10);
    const auto passes = watch.passes();
    if (passes.empty()) continue;
    EXPECT_NEAR(*passes[0].rise.sun_elevation_rad / deg, -0.8599, 0.01);
    return;
  }
  FAIL();
}

// Reference: astropy 5.2, the Moon's upper limb sets over Atlanta 8428.95 s after midnight, without
// refraction. Before that a camera that shuts for a Moon anywhere sees nothing, then as any other.
TEST(PassesOfAClosedShutter, BeginWhenTheMoonHasSet) {
  constexpr double moonset_s = 8428.95;
  const auto elements = synthetic_catalogue({.objects = 300, .seed = 3});
  SensorConfig sensor = test::at_atlanta(test::all_sky_camera(), 10.0);
  Watch plain(sensor, elements, "2018-01-21T00:00:00Z", 14400, 10);
  sensor.camera.exclusion = {
      .sun_deg = {}, .moon_deg = 180.0, .earth_limb_deg = {}, .action = ExclusionAction::flag};
  Watch flagged(sensor, elements, "2018-01-21T00:00:00Z", 14400, 10);
  sensor.camera.exclusion.action = ExclusionAction::close_shutter;
  Watch closed(sensor, elements, "2018-01-21T00:00:00Z", 14400, 10);
  const auto all = plain.passes(), marked = flagged.passes(), left = closed.passes();
  ASSERT_EQ(marked.size(), all.size());
  std::size_t later = 0, cut = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_FALSE(all[k].excluded);
    EXPECT_EQ(marked[k].rise.time, all[k].rise.time);
    EXPECT_EQ(marked[k].excluded, all[k].rise.time.seconds() < moonset_s) << k;
    if (all[k].set.time.seconds() < moonset_s - 2.0) continue;
    const auto found = std::ranges::find_if(left, [&](const Pass& p) {
      return p.object == all[k].object && std::abs((p.set.time - all[k].set.time).seconds()) < 0.1;
    });
    if (all[k].set.time.seconds() < moonset_s + 2.0) continue;
    ASSERT_NE(found, left.end()) << k;
    const bool is_cut = all[k].rise.time.seconds() < moonset_s;
    is_cut ? ++cut : ++later;
    EXPECT_NEAR(found->rise.time.seconds(), is_cut ? moonset_s : all[k].rise.time.seconds(),
                is_cut ? 2.0 : 0.02);
    EXPECT_FALSE(found->excluded);
  }
  EXPECT_GT(later, 3u);
  EXPECT_GT(cut, 3u);
  for (const Pass& p : left) EXPECT_GT(p.rise.time.seconds(), moonset_s - 2.0);
  EXPECT_EQ(closed.sightings().seen, closed.one_by_one().seen);
}

}  // namespace
}  // namespace dmise
