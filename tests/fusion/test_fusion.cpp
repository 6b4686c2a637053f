#include "core/fusion/fusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <functional>
#include <map>
#include <random>

#include "core/base/units.h"
#include "core/orbit/sgp4/synthetic_catalogue.h"
#include "tests/support/fusion_trial.h"

namespace dmise {
namespace {

const Clock evening(Utc{2458138.5, 0.0});  // an hour after sunset over the sites
constexpr double cadence_s = 10.0;

/// Sites 440 km apart that find all that the Sun lights and that is brighter than the limit.
FusionTrialSettings good_sites(std::size_t count) {
  FusionTrialSettings s;
  for (std::size_t k = 0; k < count; ++k)
    s.sites.push_back({32 + 4.0 * double(k / 4), -88 + 4.7 * double(k % 4), 200.0});
  s.half_angle_rad = 60 * deg;
  s.sigma_rad = 2 * arcsec;
  s.detection_probability = 1.0;
  s.limiting_magnitude = 8.0;
  return s;
}

std::vector<MeanElements> objects(std::size_t count) {
  return synthetic_catalogue({.objects = count});
}

/// Ends of tracks: the last that was published of each.
struct Story {
  std::map<std::uint32_t, Track> last;
  std::vector<FusionTick> ticks;

  void add(FusionTick tick) {
    for (const Track& t : tick.tracks) last.insert_or_assign(t.id, t);
    ticks.push_back(std::move(tick));
  }
};

Story story_of(Fusion& fusion, FusionTrial& trial, int ticks) {
  Story story;
  for (int k = 0; k < ticks; ++k) {
    const SimTime time = sim_seconds(k * cadence_s);
    story.add(fusion.step(time, trial.frames(time, std::uint32_t(k + 1))));
  }
  return story;
}

// An object is its catalogue's by its predicted place, and confirmed by three detections.
TEST(Fusion, CorrelatesDetectionsWithTheCatalogue) {
  FusionTrial trial(objects(3000), evening, good_sites(3));
  Fusion fusion(objects(3000), evening, {});
  const Story story = story_of(fusion, trial, 6);
  std::size_t confirmed = 0, detections = 0;
  for (const FusionTick& tick : story.ticks) {
    EXPECT_EQ(tick.unassociated, 0u);
    for (const Track& track : tick.tracks)
      for (const std::string& id : track.associated) {
        ++detections;
        EXPECT_EQ(trial.truth(id), track.catalogue_number) << id;
      }
  }
  EXPECT_EQ(detections, trial.truths().size());
  for (const auto& [id, track] : story.last) {
    confirmed += track.status == TrackStatus::confirmed;
    EXPECT_TRUE(track.status != TrackStatus::confirmed || track.detections >= 3);
  }
  EXPECT_GT(confirmed, 15u);
}

// Two objects are 2 km apart, each known to some kilometres, and one is seen: which it is, is not
// known, and the track of either is less than certain. One that is alone is.
TEST(Fusion, ADetectionBetweenTwoObjectsIsNoProof) {
  FusionTrial all(objects(3000), evening, good_sites(1));
  const auto frames = all.frames(sim_seconds(0), 1);
  ASSERT_FALSE(frames[0].sources.empty());
  const std::uint32_t seen = all.truth(frames[0].sources[0].observation.detection_id);
  auto catalogue = objects(3000);
  std::erase_if(catalogue, [&](const MeanElements& e) { return e.catalogue_number != seen; });
  ASSERT_EQ(catalogue.size(), 1u);
  const auto existence = [&] {
    auto only = frames;
    only[0].sources.resize(1);
    Fusion fusion(catalogue, evening, {});
    fusion.step(sim_seconds(0), only);
    return fusion.targets(sim_seconds(0)).at(0).existence;
  };
  EXPECT_GT(existence(), 0.99);
  MeanElements beside = catalogue[0];
  beside.catalogue_number += 100000;
  beside.mean_anomaly_rad += 2e3 / 7.2e6;
  catalogue.push_back(beside);
  EXPECT_LT(existence(), 0.8);
  EXPECT_GT(existence(), 0.3);
}

// Elements that are wrong by 500 km along the orbit predict nothing that is seen.
TEST(Fusion, LeavesAloneWhatIsFarFromThePrediction) {
  FusionTrialSettings settings = good_sites(1);
  FusionTrial trial(objects(3000), evening, settings);
  auto wrong = objects(3000);
  for (MeanElements& e : wrong) e.mean_anomaly_rad += 4 * deg;
  Fusion fusion(wrong, evening, {});
  for (int k = 0; k < 3; ++k) {
    const SimTime time = sim_seconds(k * cadence_s);
    for (const Track& t : fusion.step(time, trial.frames(time, std::uint32_t(k + 1))).tracks)
      for (const std::string& id : t.associated) EXPECT_NE(trial.truth(id), t.catalogue_number);
  }
}

// Reference: the path that made the detections.
TEST(Fusion, StartsOrbitsOfWhatIsInNoCatalogueFromTwoSites) {
  FusionTrial trial(objects(2000), evening, good_sites(4));
  Fusion fusion({}, evening, {});
  constexpr int ticks = 15;
  const Story story = story_of(fusion, trial, ticks);
  TrackLedger ledger;
  for (const FusionTick& tick : story.ticks) ledger.add(tick.tracks);
  const TrackingScore score = ledger.score(trial, 16);
  EXPECT_GT(score.objects, 10u);
  EXPECT_GE(score.completeness(), 0.9);
  EXPECT_GE(score.purity(), 0.99);

  CataloguePrediction paths(objects(2000), evening, {});
  paths.move(sim_seconds((ticks - 1) * cadence_s));
  double normalised = 0;
  int compared = 0;
  for (const Track& track : story.ticks.back().tracks) {
    if (track.status != TrackStatus::confirmed || track.detections < 30) continue;
    const std::uint32_t object = trial.truth(track.associated.front());
    for (std::size_t i = 0; i < paths.size(); ++i) {
      if (paths.elements(i).catalogue_number != object) continue;
      const Vec<Gcrs> error = paths.position_m(i) - track.position_m;
      const double variance = track.covariance[0] + track.covariance[2] + track.covariance[5];
      EXPECT_LT(norm(error), 5 * std::sqrt(variance));
      normalised += dot(error, error) / variance;
      ++compared;
    }
  }
  ASSERT_GT(compared, 5);
  EXPECT_LT(normalised / compared, 2.0);
}

/// The objects of which a network tells most, each at more than one site.
std::vector<MeanElements> most_seen(std::size_t count, int ticks) {
  std::vector<MeanElements> all = objects(3000);
  FusionTrial trial(all, evening, good_sites(4));
  for (int k = 0; k < ticks; ++k) trial.frames(sim_seconds(k * cadence_s), std::uint32_t(k + 1));
  std::map<std::uint32_t, int> seen;
  for (const auto& [id, object] : trial.truths()) ++seen[object];
  std::ranges::stable_sort(all, std::greater(),
                           [&](const MeanElements& e) { return seen[e.catalogue_number]; });
  all.resize(count);
  return all;
}

/// Turns all directions of a frame alike, and tells of it where `stated`.
void jitter(SensorFrame& frame, double sigma_rad, bool stated, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, sigma_rad);
  const SkyTangents tangents = sky_tangents(frame.axis);
  const Vec<Gcrs> turn = normal(random) * tangents.east + normal(random) * tangents.north;
  for (SeenSource& source : frame.sources) {
    AngleObservation& seen = source.observation;
    seen.direction = unit(seen.direction + cross(turn, seen.direction));
    if (!stated) continue;
    seen.covariance_rad2[0] += sigma_rad * sigma_rad;
    seen.covariance_rad2[2] += sigma_rad * sigma_rad;
  }
}

/// Tracks of four bright objects, known to 0.3 arcsec, through jitter of 1 arcsec.
struct JitteredTracks {
  std::size_t made = 0;
  double nees = 0.0;  // mean over positions
};

JitteredTracks tracks_through_jitter(bool stated, unsigned seed) {
  constexpr int ticks = 15;
  static const std::vector<MeanElements> four = most_seen(4, ticks);
  FusionTrialSettings settings = good_sites(4);
  settings.sigma_rad = 0.3 * arcsec;
  settings.seed = seed;
  FusionTrial trial(four, evening, settings);
  Fusion fusion({}, evening, {});
  std::mt19937_64 random(seed);
  Story story;
  const SimTime end = sim_seconds((ticks - 1) * cadence_s);
  for (int k = 0; k < ticks; ++k) {
    const SimTime time = sim_seconds(k * cadence_s);
    auto frames = trial.frames(time, std::uint32_t(k + 1));
    for (SensorFrame& frame : frames) jitter(frame, 1 * arcsec, stated, random);
    story.add(fusion.step(time, frames));
  }
  JitteredTracks out;
  for (const auto& [id, track] : story.last) out.made += track.status != TrackStatus::tentative;
  CataloguePrediction paths(four, evening, {});
  paths.move(end);
  const auto targets = fusion.targets(end);
  for (const CueTarget& target : targets) {
    OrbitState truth{.time = end};
    for (std::size_t i = 0; i < paths.size(); ++i)
      if (i == 0 || norm(paths.position_m(i) - target.estimate.state.position_m) <
                        norm(truth.position_m - target.estimate.state.position_m))
        truth.position_m = paths.position_m(i), truth.velocity_m_per_s = paths.velocity_m_per_s(i);
    out.nees += nees(target.estimate, truth, 3) / double(targets.size());
  }
  return out;
}

// Reference: the path that made the detections. A normalised square error of 3 for three
// coordinates; the mean of 32 is known to 0.43.
TEST(Fusion, JitterThatIsStatedLeavesTracksConsistent) {
  constexpr unsigned seeds = 8;
  std::size_t made = 0, made_unknown = 0;
  double error2 = 0.0, error2_unknown = 0.0;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const JitteredTracks told = tracks_through_jitter(true, seed),
                         not_told = tracks_through_jitter(false, seed);
    EXPECT_EQ(told.made, 4u) << seed;
    made += told.made, made_unknown += not_told.made;
    error2 += told.nees / seeds, error2_unknown += not_told.nees / seeds;
  }
  std::printf("stated: %zu tracks, NEES %.2f; not stated: %zu tracks, NEES %.1f\n", made, error2,
              made_unknown, error2_unknown);
  EXPECT_NEAR(error2, 3.0, 3 * 0.43);
  EXPECT_GT(error2_unknown, 10.0);
}

// Reference: the path that made the detections. One site alone, with false alarms and misses: what
// is seen for minutes is found, with errors that are told, and nothing else is.
TEST(Fusion, StartsOrbitsOfWhatOneSiteAloneSees) {
  FusionTrialSettings settings = good_sites(1);
  settings.detection_probability = 0.85;
  settings.false_alarms_per_frame = 0.5;
  FusionTrial trial(objects(4000), evening, settings);
  Fusion fusion({}, evening, {});
  constexpr int ticks = 36;
  const Story story = story_of(fusion, trial, ticks);
  TrackLedger ledger;
  for (const FusionTick& tick : story.ticks) ledger.add(tick.tracks);
  const TrackingScore score = ledger.score(trial, 15);
  EXPECT_GE(score.objects, 10u);
  EXPECT_GE(score.completeness(), 0.7);
  EXPECT_GE(score.purity(), 0.97);
  EXPECT_EQ(score.of_noise, 0u);

  CataloguePrediction paths(objects(4000), evening, {});
  int compared = 0, beyond = 0;
  for (int k = 0; k < ticks; ++k) {
    paths.move(sim_seconds(k * cadence_s));
    for (const Track& track : story.ticks[std::size_t(k)].tracks) {
      if (track.status != TrackStatus::confirmed || track.associated.empty()) continue;
      const std::uint32_t object = trial.truth(track.associated.front());
      for (std::size_t i = 0; i < paths.size(); ++i) {
        if (paths.elements(i).catalogue_number != object) continue;
        const double variance = track.covariance[0] + track.covariance[2] + track.covariance[5];
        ++compared;
        beyond += norm(paths.position_m(i) - track.position_m) > 4 * std::sqrt(variance);
      }
    }
  }
  EXPECT_GT(compared, 20);
  EXPECT_LE(beyond, compared / 20);
}

TEST(Fusion, StartsNothingFromOneSiteIfThatIsOff) {
  FusionTrial trial(objects(1000), evening, good_sites(1));
  FusionSettings settings;
  settings.arc_exposures = 0;
  Fusion fusion({}, evening, {}, settings);
  const Story story = story_of(fusion, trial, 12);
  EXPECT_TRUE(story.last.empty());
  EXPECT_GT(story.ticks.back().unassociated, 0u);
}

TEST(Fusion, MakesNoTrackOfNoise) {
  FusionTrialSettings settings = good_sites(8);
  settings.false_alarms_per_frame = 10;
  FusionTrial trial({}, evening, settings);
  Fusion fusion(objects(3000), evening, {});
  const Story story = story_of(fusion, trial, 60);
  EXPECT_GT(trial.truths().size(), 4000u);
  for (const FusionTick& tick : story.ticks)
    for (const Track& track : tick.tracks) EXPECT_NE(track.status, TrackStatus::confirmed);
}

// A look that shows nothing where a bright object should be lowers its probability to exist; a sky
// that nobody looks at does not.
TEST(Fusion, LooksThatSeeNothingEndATrack) {
  for (const bool look : {true, false}) {
    FusionTrial trial(objects(3000), evening, good_sites(4));
    Fusion fusion(objects(3000), evening, {});
    Story story = story_of(fusion, trial, 5);
    const auto live = story.ticks.back().live;
    ASSERT_GT(live, 20u);
    double most = 0;
    std::size_t lost = 0;
    for (int k = 5; k < 9; ++k) {
      const SimTime time = sim_seconds(k * cadence_s);
      auto frames = trial.frames(time, std::uint32_t(k + 1));
      for (SensorFrame& frame : frames) frame.sources.clear();
      if (!look) frames.clear();
      for (const Track& t : fusion.step(time, std::move(frames)).tracks)
        lost += t.status == TrackStatus::lost;
    }
    for (const CueTarget& target : fusion.targets(sim_seconds(8 * cadence_s)))
      most = std::max(most, target.existence);
    if (look) {
      EXPECT_GT(lost, live / 2);
    } else {
      EXPECT_EQ(lost, 0u);
      EXPECT_GT(most, 0.99);
    }
  }
}

std::vector<FusionTick> with_frames(FusionTrial& trial, int ticks,
                                    const std::function<void(std::vector<SensorFrame>&)>& change) {
  Fusion fusion(objects(3000), evening, {});
  std::vector<FusionTick> out;
  for (int k = 0; k < ticks; ++k) {
    const SimTime time = sim_seconds(k * cadence_s);
    auto frames = trial.frames(time, std::uint32_t(k + 1));
    change(frames);
    out.push_back(fusion.step(time, std::move(frames)));
  }
  return out;
}

TEST(Fusion, DoesNotDependOnTheOrderOfArrival) {
  FusionTrialSettings settings = good_sites(4);
  settings.false_alarms_per_frame = 3;
  FusionTrial trial(objects(3200), evening, settings);
  const auto forward = with_frames(trial, 8, [](auto&) {});
  const auto backward = with_frames(trial, 8, [](auto& f) { std::ranges::reverse(f); });
  ASSERT_EQ(forward.size(), backward.size());
  std::size_t tracks = 0;
  for (std::size_t k = 0; k < forward.size(); ++k) {
    EXPECT_EQ(forward[k].tracks, backward[k].tracks);
    tracks += forward[k].tracks.size();
  }
  EXPECT_GT(tracks, 100u);
}

// Two of four sites are heard three ticks late: their detections find their tracks all the same.
TEST(Fusion, TakesDetectionsThatComeLate) {
  FusionTrial trial(objects(3000), evening, good_sites(4));
  std::deque<std::vector<SensorFrame>> waiting;
  TrackLedger ledger;
  std::size_t unassociated = 0;
  for (const FusionTick& tick : with_frames(trial, 12, [&](std::vector<SensorFrame>& frames) {
         waiting.push_back({frames.begin() + 2, frames.end()});
         frames.resize(2);
         if (waiting.size() <= 3) return;
         frames.insert(frames.end(), waiting.front().begin(), waiting.front().end());
         waiting.pop_front();
       })) {
    ledger.add(tick.tracks);
    unassociated += tick.unassociated;
  }
  const TrackingScore score = ledger.score(trial, 16);
  EXPECT_GE(score.completeness(), 0.95);
  EXPECT_EQ(score.purity(), 1.0);
  EXPECT_LT(unassociated, trial.truths().size() / 50);
}

}  // namespace
}  // namespace dmise
