#include "core/score/score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>

#include "core/base/error.h"
#include "core/score/score_text.h"
#include "tests/score/sources.h"

namespace dmise {
namespace {

using test::found;
using test::frame;
using test::source;

std::size_t count(const SensorScore& s, Fate fate) { return s.fates[std::size_t(fate)]; }
const ScoredTruth& named(const Score& s, const std::string& id) {
  return *std::ranges::find(s.truths, id, [](const ScoredTruth& t) { return t.truth.id; });
}

/// One truth of each fate, a streak in pieces, and two false alarms.
ScoreInput all_fates() {
  ScoreInput in{.source = "hand-made", .status = "complete", .frames = {frame("1"), frame("2")}};
  in.frames.push_back(frame("3"));
  in.frames.back().searched = false;
  in.truths = {source("found", {100, 100}, {200, 100}),
               source("missed", {300, 300}, {400, 300}),
               source("faint", {500, 500}, {600, 500}),
               source("dark", {700, 700}, {750, 700}),
               source("outside", {-50, 900}, {-20, 900}),
               source("pieces", {100, 400}, {400, 400}),
               source("no frame", {100, 100}, {200, 100}, "9"),
               source("not searched", {100, 100}, {200, 100}, "3"),
               source("point", {50, 50}, {50, 50}, "2")};
  in.truths[2].signal_e = 100.0;  // SNR 0.9
  in.truths[3].light.reset();
  in.truths[4].light.reset();
  in.detections = {found(0, {100, 100}, {200, 100}),  found(1, {100, 400}, {240, 400}),
                   found(2, {250, 400}, {400, 400}),  found(3, {800, 20}, {800, 20}),
                   found(0, {50, 50}, {50, 50}, "2"), found(1, {600, 600}, {640, 660}, "2"),
                   found(0, {5, 5}, {5, 5}, "9")};
  return in;
}

TEST(Score, EachTruthHasTheFateThatItDeserves) {
  const Score s = score(all_fates(), {});
  for (const char* name : {"found", "missed", "faint", "dark", "outside"})
    EXPECT_EQ(fate_names[std::size_t(named(s, name).fate)], std::string(name));
  EXPECT_EQ(named(s, "no frame").fate, Fate::unscored);
  EXPECT_EQ(named(s, "not searched").fate, Fate::unscored);
  EXPECT_EQ(named(s, "pieces").fate, Fate::found);
  EXPECT_EQ(named(s, "pieces").pieces, 2u);
  const SensorScore& total = s.sensors.back();
  EXPECT_EQ(total.in_pieces, 1u);
  EXPECT_EQ(total.further_pieces, 1u);
  EXPECT_EQ(total.false_alarms, 2u);
  EXPECT_EQ(total.unscored_detections, 1u);
  EXPECT_EQ(total.frames, 3u);
  EXPECT_EQ(total.unsearched_frames, 1u);
  EXPECT_DOUBLE_EQ(total.megapixels, 1.6);
  // Found: "found", "pieces", "point"; missed: one; the faint one counts in neither.
  EXPECT_EQ(total.detection.truths, 4u);
  EXPECT_EQ(total.detection.found, 3u);
}

void expect_sums(const Score& s) {
  SensorScore sum;
  for (std::size_t k = 0; k < s.sensors.size(); ++k) {
    const SensorScore& one = s.sensors[k];
    EXPECT_EQ(std::accumulate(one.fates.begin(), one.fates.end(), std::size_t(0)), one.truths);
    EXPECT_EQ(
        count(one, Fate::found) + one.further_pieces + one.false_alarms + one.unscored_detections,
        one.detections);
    std::size_t in_bins = 0;
    for (const Bin& bin : one.by_snr) in_bins += bin.truths;
    EXPECT_EQ(in_bins,
              count(one, Fate::found) + count(one, Fate::missed) + count(one, Fate::faint));
    if (k + 1 == s.sensors.size()) continue;
    sum.truths += one.truths;
    sum.detections += one.detections;
    sum.false_alarms += one.false_alarms;
    sum.frames += one.frames;
  }
  EXPECT_EQ(sum.truths, s.sensors.back().truths);
  EXPECT_EQ(sum.detections, s.sensors.back().detections);
  EXPECT_EQ(sum.false_alarms, s.sensors.back().false_alarms);
  EXPECT_EQ(sum.frames, s.sensors.back().frames);
  EXPECT_EQ(s.truths.size(), s.sensors.back().truths);
  EXPECT_EQ(s.false_alarms.size(), s.sensors.back().false_alarms);
}

TEST(Score, CountsAddUp) { expect_sums(score(all_fates(), {})); }

TEST(Score, RandomScenesAddUpAndDoNotDependOnTheOrderOfLines) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(-200, 1200), y(-200, 1000), length(-120, 120),
      error(-2, 2), decades(2, 6);
  for (int scene = 0; scene < 20; ++scene) {
    ScoreInput in{.frames = {frame("1"), frame("2"), frame("10"), frame("1", "nose")}};
    std::uint32_t index = 0;
    for (int k = 0; k < 60; ++k) {
      const std::string name = k % 3 == 0   ? "1"
                               : k % 3 == 1 ? "10"
                                            : "7",
                        sensor = k % 4 == 0 ? "nose" : "eye";
      const PixelPosition start{x(random), y(random)};
      const PixelPosition end = start + PixelPosition{length(random), length(random)};
      in.truths.push_back(source(std::to_string(k), start, end, name, sensor));
      TrueSource& t = in.truths.back();
      t.signal_e = std::pow(10.0, decades(random));
      if (t.light->x_px < 0 || t.light->y_px < 0 || t.light->x_px > 999 || t.light->y_px > 799)
        t.light.reset();
      if (k % 5 > 0)
        in.detections.push_back(found(index++, start + PixelPosition{error(random), error(random)},
                                      end + PixelPosition{error(random), error(random)}, name,
                                      sensor));
      if (k % 7 == 0) in.detections.push_back(found(index++, start * 0.5, end * 0.7, name, sensor));
    }
    const Score first = score(in, {});
    expect_sums(first);
    std::ranges::shuffle(in.frames, random);
    std::ranges::shuffle(in.truths, random);
    std::ranges::shuffle(in.detections, random);
    const Score second = score(in, {});
    EXPECT_EQ(score_json(first), score_json(second));
    EXPECT_EQ(score_csv(first), score_csv(second));
    EXPECT_EQ(score_table(first), score_table(second));
  }
}

// A streak of 100 px along (0.6, 0.8), of 2 s: found 0.3 px along and 0.2 px to the right of it,
// its start 1 px early and its end 2 px early.
TEST(Score, MagnitudesAreComparedInBandsThatAreV) {
  const PixelPosition start{100, 100}, end{160, 180};
  for (const auto& [band, compared] : std::map<std::string, bool>{
           {"V", true}, {"bessell-V", true}, {"bessell-R", false}, {"UV", false}, {"", false}}) {
    ScoreInput in{.frames = {frame()}, .truths = {source("a", start, end)}};
    in.truths[0].start_time = SimTime{1000000000};
    in.truths[0].magnitude = 8.0;
    in.detections = {found(0, start, end)};
    in.detections[0].detection.band = band;
    in.detections[0].detection.magnitude = 8.5;
    EXPECT_EQ(score(in, {}).truths[0].errors.magnitude.has_value(), compared) << band;
  }
}

TEST(Score, ErrorsAreAlongAndAcrossTheTrail) {
  const PixelPosition along{0.6, 0.8}, right{-0.8, 0.6}, start{100, 100}, end{160, 180};
  ScoreInput in{.frames = {frame()}, .truths = {source("a", start, end)}};
  TrueSource& t = in.truths[0];
  t.start_time = SimTime{1000000000};
  t.end_time = SimTime{3000000000};
  t.magnitude = 8.0;
  t.ra_rad = 359.9999 * deg;
  t.dec_rad = 60.0 * deg;
  // Ends by smaller x: end 1 is the start.
  in.detections = {found(0, start - along + right * 0.2, end - along * 2.0 + right * 0.2)};
  Detection& d = in.detections[0].detection;
  const PixelPosition light = *t.light + along * 0.3 + right * 0.2;
  d.x_px = light.x_px;
  d.y_px = light.y_px;
  d.covariance_px2 = {0.04, 0.01, 0.09};
  d.end1_time = *t.start_time;
  d.end2_time = *t.end_time;
  d.magnitude = 8.03;
  d.magnitude_sigma = 0.02;
  d.signal_e = 0.99e5;
  d.position_angle_rad = 90.0 * deg;                // to the east
  d.corrected_ra_rad = 0.0001 * deg;                // 0.0002 deg cos 60 = 0.36 arcsec east
  d.corrected_dec_rad = 60.0 * deg + 0.5 * arcsec;  // 0.5 arcsec north
  const Score s = score(in, {});
  const MatchErrors& e = s.truths[0].errors;
  EXPECT_NEAR(*e.along_px, 0.3, 1e-9);
  EXPECT_NEAR(*e.across_px, 0.2, 1e-9);
  // d = (0.02, 0.36): (x^2 cyy - 2 x y cxy + y^2 cxx) / det / 2 with det = 0.0035.
  EXPECT_NEAR(*e.nees_px, 0.5 * (0.0004 * 0.09 - 2 * 0.02 * 0.36 * 0.01 + 0.1296 * 0.04) / 0.0035,
              1e-9);
  EXPECT_NEAR(*e.along_arcsec, 0.36, 1e-4);
  EXPECT_NEAR(*e.across_arcsec, 0.5, 1e-4);  // to the left, as north is of east
  EXPECT_NEAR(*e.nees_sky, 0.5 * (0.36 * 0.36 + 0.25), 1e-3);
  EXPECT_NEAR(*e.magnitude, 0.03, 1e-12);
  EXPECT_NEAR(*e.magnitude_over_sigma, 1.5, 1e-9);
  EXPECT_NEAR(*e.flux, 0.010912, 1e-6);  // -2.5 log10(0.99)
  EXPECT_NEAR(*e.start_along_px, 1.0, 1e-9);
  EXPECT_NEAR(*e.start_across_px, 0.2, 1e-9);
  EXPECT_NEAR(*e.end_along_px, -2.0, 1e-9);
  // 50 px/s: what was at the start 20 ms before it, and at the end 40 ms before it, says the ends'.
  EXPECT_NEAR(*e.start_time_s, 0.02, 1e-9);
  EXPECT_NEAR(*e.end_time_s, 0.04, 1e-9);
  EXPECT_NEAR(*s.truths[0].rate_arcsec_per_s, 100 * 3600 / 2.0, 1e-6);
}

TEST(Score, TimesFollowADirectionThatIsKnownAndElseTheBetter) {
  ScoreInput in{.frames = {frame()},
                .truths = {source("a", {300, 100}, {200, 100})}};  // to the left
  in.truths[0].start_time = SimTime{0};
  in.truths[0].end_time = SimTime{2000000000};
  in.detections = {found(0, {200, 100}, {300, 100})};
  in.detections[0].detection.end2_time = SimTime{2000000000};
  EXPECT_NEAR(*score(in, {}).truths[0].errors.start_time_s, 0.0, 1e-9);
  in.detections[0].detection.direction_known = true;  // and wrong
  EXPECT_NEAR(*score(in, {}).truths[0].errors.start_time_s, 2.0, 1e-9);
  EXPECT_NEAR(*score(in, {}).truths[0].errors.end_time_s, -2.0, 1e-9);
}

// Positions drawn with the covariance that they state: mean NEES / 2 is 1 within its interval, and
// ten times too large for a third of the sigma.
TEST(Score, NeesIsOneIfCovariancesAreHonest) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const auto mean_nees = [&](double honesty) {
    ScoreInput in;
    for (int k = 0; k < 2000; ++k) {
      const std::string name = std::to_string(k);
      in.frames.push_back(frame(name));
      in.truths.push_back(source("a", {100, 100}, {100, 100}, name));
      in.detections.push_back(found(0, {100, 100}, {100, 100}, name));
      const double a = normal(random), b = normal(random);
      in.detections.back().detection.x_px += 0.2 * a;
      in.detections.back().detection.y_px += 0.1 * a + 0.3 * b;
      in.detections.back().detection.covariance_px2 = {0.04 * honesty, 0.02 * honesty,
                                                       0.10 * honesty};
    }
    return score(in, {}).sensors.back().errors[0][0][4];  // nees_px of points
  };
  const ErrorFigure honest = mean_nees(1.0);
  EXPECT_EQ(honest.count, 2000u);
  EXPECT_GT(honest.mean, nees_interval(2000).low);
  EXPECT_LT(honest.mean, nees_interval(2000).high);
  EXPECT_NEAR(mean_nees(0.1).mean, 10.0, 0.7);
}

TEST(Score, CovarianceThatIsNoneHasNoNees) {
  ScoreInput in{.frames = {frame()}, .truths = {source("a", {100, 100}, {100, 100})}};
  in.detections = {found(0, {100, 100}, {100, 100})};
  in.detections[0].detection.covariance_px2 = {1.0, 1.0, 1.0};
  in.detections[0].detection.magnitude_sigma = 0.0;
  const Score s = score(in, {});
  EXPECT_FALSE(s.truths[0].errors.nees_px);
  EXPECT_FALSE(s.truths[0].errors.flux_over_sigma);
  EXPECT_NO_THROW(score_json(s));
}

TEST(Score, SaturatedCutOrBrokenDetectionsAreNotClean) {
  const auto clean = [](auto change) {
    ScoreInput in{.frames = {frame()}, .truths = {source("a", {100, 100}, {200, 100})}};
    in.detections = {found(0, {100, 100}, {200, 100})};
    change(in);
    const Score s = score(in, {});
    EXPECT_EQ(s.sensors.back().errors[1][1][0].count, 1u);
    return s.sensors.back().errors[0][1][0].count == 1;
  };
  EXPECT_TRUE(clean([](ScoreInput&) {}));
  EXPECT_FALSE(clean([](ScoreInput& in) { in.detections[0].detection.saturated = true; }));
  EXPECT_FALSE(clean([](ScoreInput& in) { in.detections[0].detection.at_edge = true; }));
  EXPECT_FALSE(clean([](ScoreInput& in) { in.truths[0].whole = false; }));
  EXPECT_FALSE(clean([](ScoreInput& in) { in.truths[0].resolved = true; }));
  EXPECT_FALSE(clean([](ScoreInput& in) {
    in.detections.push_back(found(1, {100, 100}, {110, 100}));
  }));
}

TEST(Score, NothingAtAllIsScored) {
  for (const ScoreInput& in : {ScoreInput{}, ScoreInput{.frames = {frame()}},
                               ScoreInput{.truths = {source("a", {1, 1}, {9, 1})}},
                               ScoreInput{.detections = {found(0, {1, 1}, {9, 1})}}}) {
    const Score s = score(in, {});
    expect_sums(s);
    EXPECT_NO_THROW(score_json(s));
    EXPECT_FALSE(score_table(s).empty());
    EXPECT_FALSE(score_csv(s).empty());
  }
}

// 200 px in 2 s at 3600 arcsec/px, half of them beyond the edge: an end that is outside has no
// error.
TEST(Score, TrailCutByTheEdgeKeepsItsRateAndHasNoEnds) {
  ScoreInput in{.frames = {frame()}, .truths = {source("a", {-100.5, 100}, {99.5, 100})}};
  in.truths[0].whole = false;
  in.truths[0].light = PixelPosition{49.5, 100};
  in.detections = {found(0, {-0.5, 100}, {99.5, 100})};
  const ScoredTruth t = score(in, {}).truths[0];
  EXPECT_EQ(t.fate, Fate::found);
  EXPECT_NEAR(t.length_px, 100.0, 0.2);
  EXPECT_NEAR(*t.rate_arcsec_per_s, 200 * 3600 / 2.0, 1e-6);
  EXPECT_NEAR(*t.errors.along_px, 0.0, 1e-9);
  EXPECT_FALSE(t.errors.start_along_px || t.errors.end_time_s);
}

TEST(Score, BinsHoldTheirLowerEdge) {
  ScoreInput in{.frames = {frame()}, .truths = {source("a", {100, 100}, {200, 100})}};
  in.truths[0].magnitude = 8.0;
  const Score s = score(in, {});
  ASSERT_EQ(s.sensors.back().by_magnitude.size(), 1u);
  EXPECT_EQ(s.sensors.back().by_magnitude[0].from, 8.0);
  EXPECT_EQ(s.sensors.back().by_magnitude[0].to, 9.0);
}

TEST(Score, FrameGivenTwiceIsRefused) {
  EXPECT_THROW(score({.frames = {frame(), frame()}}, {}), Error);
}

// A noise of 1e-320 e- makes an SNR of 1e324, a covariance of 1e-320 px^2 a NEES of 1e320.
TEST(Score, FiguresThatOverflowAreUnknown) {
  ScoreInput input{.frames = {test::frame()},
                   .truths = {test::source("t", {100, 100}, {160, 100})},
                   .detections = {test::found(0, {101, 100}, {161, 100})}};
  input.frames[0].noise_e = 1e-320;
  input.detections[0].detection.covariance_px2 = {1e-160, 0.0, 1e-160};
  input.detections[0].detection.y_px += 1.0;
  const ScoredTruth t = score(input, {}).truths.at(0);
  EXPECT_EQ(t.fate, Fate::found);
  EXPECT_FALSE(t.snr);
  EXPECT_FALSE(t.errors.nees_px && !std::isfinite(*t.errors.nees_px));
  EXPECT_FALSE(t.errors.over_bound && !std::isfinite(*t.errors.over_bound));
  EXPECT_NEAR(*t.errors.along_px, 1.0, 1e-9);
}

}  // namespace
}  // namespace dmise
