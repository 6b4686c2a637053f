#include "nodes/fusion/fusion_evaluator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core/base/error.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"
#include "core/config/make_clock.h"
#include "core/orbit/sgp4/synthetic_catalogue.h"
#include "core/products/frame_report.h"
#include "tests/support/fusion_trial.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

constexpr double cadence_s = 10.0;
constexpr int columns = 1000;

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Two sites, 400 km apart, of a scenario with a fusion node.
struct TwoSites {
  explicit TwoSites(const std::string& fusion = "on") {
    fs::create_directories(directory);
    std::ofstream file(directory / "two.yaml");
    file << "simulation: {start: 2018-01-20T00:00:00Z, duration_s: 100, tick_s: 10}\n"
            "fusion: " +
                fusion + "\nsensors:\n";
    for (int k = 0; k < 2; ++k)
      file << "  - {name: site10" + std::to_string(k) +
                  ", site: {latitude_deg: 32, longitude_deg: " + std::to_string(-88 + 4.2 * k) +
                  ", height_m: 200}, camera: {optics: {columns: 1000, rows: 1000, pixel_pitch_m: "
                  "1.0e-5, focal_length_m: 0.004, aperture_m: 0.004}, detector: {full_well_e: "
                  "20000, gain_e_per_dn: 1}, band: {centre_m: 0.55e-6, width_m: 0.1e-6}}, "
                  "pointing: zenith, exposure_s: 1, cadence_s: 10}\n";
    file.close();
    scenario = load_scenario(directory / "two.yaml");
    roster.elements = synthetic_catalogue({.objects = 2000});
    for (const MeanElements& e : roster.elements)
      roster.objects.push_back({.catalogue_number = e.catalogue_number,
                                .name = "OBJECT " + std::to_string(e.catalogue_number),
                                .sphere = {1.0, 0.2}});
    FusionTrialSettings settings;
    for (int k = 0; k < 2; ++k) settings.sites.push_back({32, -88 + 4.2 * k, 200});
    settings.half_angle_rad = 50 * deg;
    settings.sigma_rad = 5 * arcsec;
    settings.limiting_magnitude = 8;
    settings.false_alarms_per_frame = 2;
    trial.emplace(roster.elements, make_clock(scenario), settings);
  }
  ~TwoSites() { fs::remove_all(directory); }

  std::vector<Message> inputs(Tick tick) {
    std::vector<Message> out;
    if (tick == 0) out.push_back({roster_topic, 0, std::make_shared<State>(roster)});
    const double scale_deg = 2.5e-3 / deg;  // size of a pixel
    for (const SensorFrame& frame :
         trial->frames(sim_seconds(double(tick) * cadence_s), std::uint32_t(tick + 1))) {
      const auto boresight = to_spherical(frame.axis);
      FrameReport report{.sensor = frame.sensor,
                         .frame = frame.frame,
                         .start = frame.time,
                         .middle = frame.time,
                         .end = frame.time,
                         .boresight_ra_rad = boresight[0],
                         .boresight_dec_rad = boresight[1]};
      report.wcs.crpix_x = report.wcs.crpix_y = columns / 2.0 - 0.5;
      report.wcs.ra_rad = boresight[0], report.wcs.dec_rad = boresight[1];
      report.wcs.cd_deg = {-scale_deg, 0, 0, -scale_deg};
      report.sensor_position_m = frame.sensor_m;
      report.limiting_magnitude = frame.limiting_magnitude;
      DetectionSet set{frame.sensor, frame.frame, {}};
      for (const SeenSource& source : frame.sources) {
        Detection& d = set.detections.emplace_back();
        d.id = source.observation.detection_id;
        d.sensor = frame.sensor, d.frame = frame.frame;
        d.time = frame.time;
        const auto [ra_rad, dec_rad] = to_spherical(source.observation.direction);
        d.corrected_ra_rad = ra_rad;
        d.corrected_dec_rad = dec_rad;
        d.covariance_rad2 = source.observation.covariance_rad2;
        d.sensor_position_m = frame.sensor_m;
        d.magnitude = source.magnitude;
      }
      out.push_back({frame_prefix + frame.sensor, tick, std::make_shared<State>(report)});
      out.push_back({detection_prefix + frame.sensor, tick, std::make_shared<State>(set)});
    }
    return out;
  }

  fs::path directory = fs::path(testing::TempDir()) / "fusion";
  Scenario scenario;
  ObjectRoster roster;
  std::optional<FusionTrial> trial;
};

TrackSet tracks_of(const std::vector<Message>& messages) {
  return std::get<TrackSet>(*messages.at(0).state);
}

std::vector<TrackSet> steps(FusionEvaluator& node, TwoSites& run, Tick from, Tick last) {
  std::vector<TrackSet> out;
  for (Tick k = from; k <= last; ++k) out.push_back(tracks_of(node.step(k, run.inputs(k))));
  return out;
}

// Two sensors see the same objects: each becomes one track, with detections of both.
TEST(FusionEvaluator, PublishesOneTrackOfWhatTwoSensorsSee) {
  TwoSites run;
  FusionEvaluator node(run.scenario, make_clock(run.scenario), run.directory / "out");
  TrackLedger ledger;
  std::size_t of_both = 0;
  for (const TrackSet& set : steps(node, run, 0, 9)) {
    EXPECT_EQ(set.node, "fusion-node");
    EXPECT_EQ(set.time, run.scenario.time_of(set.tick));
    ledger.add(set.tracks);
    for (const Track& t : set.tracks) {
      of_both += t.associated.size() == 2;
      EXPECT_TRUE(t.catalogue_number == 0 ||
                  t.name == "OBJECT " + std::to_string(t.catalogue_number));
    }
  }
  EXPECT_GT(of_both, 50u);
  const TrackingScore score = ledger.score(*run.trial, 8);
  EXPECT_EQ(score.completeness(), 1.0);
  EXPECT_GE(score.purity(), 0.99);
}

TEST(FusionEvaluator, GoesOnToTheByteWhereAnotherEnded) {
  TwoSites run;
  const auto directory = [&](const char* name) { return (run.directory / name).string(); };
  FusionEvaluator whole(run.scenario, make_clock(run.scenario), directory("whole"));
  const auto expected = steps(whole, run, 0, 9);
  EXPECT_EQ(InputJournal::ticks_written(input_journal_path(directory("whole"), fusion_node)), 10);
  {  // a process that ends after tick 6
    FusionEvaluator first(run.scenario, make_clock(run.scenario), directory("parts"));
    steps(first, run, 0, 6);
  }
  FusionEvaluator second(run.scenario, make_clock(run.scenario), directory("parts"));
  second.resume(5, {});  // the others had not done it
  const auto rest = steps(second, run, 5, 9);
  for (std::size_t k = 0; k < rest.size(); ++k) EXPECT_EQ(rest[k], expected[5 + k]) << k;
  EXPECT_EQ(text_of(directory("parts") + "/tracks.jsonl"),
            text_of(directory("whole") + "/tracks.jsonl"));
  EXPECT_GT(text_of(directory("parts") + "/tracks.jsonl").size(), 1000u);
}

TEST(FusionEvaluator, DoesNotGoOnWithoutItsInputs) {
  TwoSites run;
  FusionEvaluator node(run.scenario, make_clock(run.scenario), run.directory / "out");
  EXPECT_THROW(node.resume(3, {}), Error);
  // A journal that is cut within a tick has the ticks before.
  steps(node, run, 0, 3);
  const std::string path = input_journal_path(run.directory / "out", fusion_node);
  fs::resize_file(path, fs::file_size(path) - 3);
  EXPECT_EQ(InputJournal::ticks_written(path), 3);
}

// What a program that was started again hears: the ticks that it has not, as they were.
TEST(FusionEvaluator, ItsJournalRepeatsSomeTicks) {
  TwoSites run;
  FusionEvaluator node(run.scenario, make_clock(run.scenario), run.directory / "out");
  steps(node, run, 0, 5);
  const InputJournal journal(input_journal_path(run.directory / "out", fusion_node));
  std::vector<Tick> heard;
  journal.replay(2, 5, [&](Tick tick, std::span<const Message> inputs) {
    heard.push_back(tick);
    const auto expected = run.inputs(tick);
    ASSERT_EQ(inputs.size(), expected.size());
    for (std::size_t i = 0; i < inputs.size(); ++i) EXPECT_EQ(*inputs[i].state, *expected[i].state);
  });
  EXPECT_EQ(heard, (std::vector<Tick>{2, 3, 4}));
  EXPECT_THROW(journal.replay(2, 9, [](Tick, std::span<const Message>) {}), Error);
}

TEST(FusionEvaluator, KnowsNoObjectThatIsInNoCatalogue) {
  TwoSites run("{not_in_catalogue: [OBJECT 5, \"7\"]}");
  FusionEvaluator node(run.scenario, make_clock(run.scenario), run.directory / "out");
  for (const TrackSet& set : steps(node, run, 0, 5))
    for (const Track& t : set.tracks)
      EXPECT_TRUE(t.catalogue_number != 5 && t.catalogue_number != 7);
}

/// Variance of position [m^2] of the tracks of each tick, by catalogue number.
std::map<std::pair<Tick, std::uint32_t>, double> position_variances(const std::string& fusion) {
  TwoSites run(fusion);
  FusionEvaluator node(run.scenario, make_clock(run.scenario), run.directory / "out");
  std::map<std::pair<Tick, std::uint32_t>, double> out;
  for (const TrackSet& set : steps(node, run, 0, 9))
    for (const Track& t : set.tracks)
      out[{set.tick, t.catalogue_number}] = t.covariance[0] + t.covariance[2] + t.covariance[5];
  return out;
}

// Detections tell 5 arcsec, and the sensors' pointing is stated to be off by 20 more.
TEST(FusionEvaluator, AStatedErrorOfPointingIsInTheCovarianceOfTracks) {
  const auto stated = position_variances("{pointing_sigma_arcsec: 20}");
  std::vector<double> growth;
  for (const auto& [track, variance_m2] : position_variances("on"))
    if (const auto wide = stated.find(track); track.second && wide != stated.end())
      growth.push_back(wide->second / variance_m2);
  EXPECT_GT(growth.size(), 50u);
  EXPECT_GT(*std::ranges::min_element(growth), 1.0);
  EXPECT_GT(median_of(growth), 4.0);
}

// The scheduler keeps from what closes a camera's shutter, as far as the scenario does not keep
// farther; what is flagged alone it may look at.
TEST(CuedSensor, IsKeptFromWhereItsShutterIsClosed) {
  SensorConfig sensor{.name = "eye", .place = SiteConfig{"", 33.7, -84.4, 0.0}};
  sensor.camera.optics.columns = sensor.camera.optics.rows = 100;
  sensor.camera.optics.focal_length_m = 1.0;
  sensor.camera.optics.pixel_pitch_m = 1e-5;
  EXPECT_FALSE(cued_sensor(sensor));
  PointCued cued;
  cued.cue.sun_exclusion_deg = 30.0;
  cued.cue.moon_exclusion_deg = 5.0;
  sensor.pointing = cued;
  sensor.camera.exclusion = {.sun_deg = 40.0, .moon_deg = 3.0, .earth_limb_deg = {}};
  EXPECT_EQ(cued_sensor(sensor)->cue.sun_exclusion_deg, 30.0);
  sensor.camera.exclusion.action = ExclusionAction::close_shutter;
  EXPECT_EQ(cued_sensor(sensor)->cue.sun_exclusion_deg, 40.0);
  EXPECT_EQ(cued_sensor(sensor)->cue.moon_exclusion_deg, 5.0);
}

}  // namespace
}  // namespace dmise
