#include "sensors/survey/sensor_survey.h"

#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/visibility/passes.h"
#include "sensors/accuracy/rendered_check.h"
#include "tests/survey/network.h"

namespace dmise {
namespace {

using test::evening;
using test::Network;
using test::zenith_camera;

std::set<std::uint32_t> objects_of(const SensorSurvey& survey) {
  std::set<std::uint32_t> objects;
  for (const auto& pass : survey.passes) objects.insert(pass.object);
  return objects;
}

double expected_of(const SensorSurvey& survey) {
  double sum = 0.0;
  for (const auto& e : survey.exposures) sum += e.expected;
  return sum;
}

// The frames are drawn by the whole chain, which knows nothing of the survey: every object has the
// light there that the survey expects, but for what the blur throws over the frame's edge.
TEST(SensorSurvey, LightIsThatOfRenderedFrames) {
  Network network(
      evening,
      {zenith_camera("a"),
       zenith_camera("b", ", mask_deg: 0, weather: {clouds: {transmission: 0.5}}", "savannah")});
  const RenderedCheck check =
      check_rendered(*network.scene, 40, FrameHalf::even, network.threads, {});
  EXPECT_EQ(check.frames, 40u);
  std::size_t compared = 0;
  for (const auto& o : check.objects) {
    const double x = o.look.centroid.x_px, y = o.look.centroid.y_px;
    const double reach = 0.6 * o.look.length_px + 5.0;
    if (x < reach || y < reach || x > 799 - reach || y > 799 - reach) continue;
    EXPECT_NEAR(o.look.signal_e / o.signal_e, 1.0, 0.005)
        << o.sensor << " " << o.frame << " " << o.catalogue_number;
    ++compared;
  }
  EXPECT_GT(compared, 30u);
}

// `passes_of` finds passes by bisection, without exposures: what is sunlit in the field for longer
// than the time between two exposures is covered, and nothing else.
TEST(SensorSurvey, CoverageOfOneSiteIsThatOfVisible) {
  Network network("{start: 2018-01-20T22:00:00Z, duration_s: 10800, tick_s: 10}",
                  {zenith_camera("a", ", mask_deg: 20")});
  const SensorSurvey survey = network.survey();
  ASSERT_FALSE(survey.exposures.empty());
  const SimTime from = survey.exposures.front().middle, to = survey.exposures.back().middle;
  const EphemerisTable sky(network.scene->clock(), {0}, network.scenario.duration);
  const auto& batch = network.scene->source().elements();
  const SensorTrack track(network.scenario.sensors[0], sky, batch, std::nullopt, std::nullopt);
  const auto passes = passes_of(
      batch, track,
      find_sightings(batch, track, covering_grid(from, to - from, sim_seconds(60)), network.threads)
          .intervals,
      network.threads);
  std::set<std::uint32_t> may, must;
  for (const Pass& pass : passes) {
    if (pass.lit_s > 0.0) may.insert(pass.object);
    // All of it lit, and longer than the time between two exposures.
    const double length_s = (pass.set.time - pass.rise.time).seconds();
    if (pass.lit_s > 21.0 && pass.lit_s > 0.99 * length_s) must.insert(pass.object);
  }
  const auto covered = objects_of(survey);
  EXPECT_GT(must.size(), 10u);
  for (const auto object : must) EXPECT_TRUE(covered.count(object)) << object;
  // Half an exposure before the first middle and after the last there may be more.
  std::size_t beyond = 0;
  for (const auto object : covered) beyond += !may.count(object);
  EXPECT_LE(beyond, 2u);
}

TEST(SensorSurvey, ExposuresAreThoseAtNight) {
  Network network("{start: 2018-01-20T22:00:00Z, duration_s: 10800, tick_s: 10}",
                  {zenith_camera("a")});
  const SensorSurvey survey = network.survey();
  EXPECT_EQ(survey.frames, 540u);
  ASSERT_FALSE(survey.exposures.empty());
  EXPECT_LT(survey.exposures.size(), 540u);
  for (const auto& e : survey.exposures) EXPECT_LT(*e.sun_elevation_rad, -6.0 * deg);
  // astropy (get_sun, AltAz without air): the Sun is at -6 deg 5019.8 s after 22:00.
  EXPECT_GE(survey.exposures.front().middle.seconds(), 5019.8);
  EXPECT_LE(survey.exposures.front().middle.seconds(), 5019.8 + 20.5);
}

TEST(SensorSurvey, AnyNumberOfThreadsGivesTheSame) {
  const auto by = [](int threads) {
    Network network(evening, {zenith_camera("a")}, "[{catalogue: demo}]", threads);
    return network.survey();
  };
  const SensorSurvey one = by(1);
  EXPECT_EQ(one, by(3));
  EXPECT_GT(expected_of(one), 1.0);
}

TEST(SensorSurvey, PolarSummerHasNoNight) {
  Network network("{start: 2018-06-21T00:00:00Z, duration_s: 86400, tick_s: 10}",
                  {zenith_camera("a", "", "{latitude_deg: 78.2, longitude_deg: 15.6}")});
  const SensorSurvey survey = network.survey();
  EXPECT_GT(survey.frames, 4000u);
  EXPECT_TRUE(survey.exposures.empty());
  EXPECT_TRUE(survey.passes.empty());
}

TEST(SensorSurvey, AtBothPolesItIsNightOrDayAndNumbersAreFinite) {
  Network network(evening, {zenith_camera("n", "", "{latitude_deg: 90, longitude_deg: 0}"),
                            zenith_camera("s", "", "{latitude_deg: -90, longitude_deg: 0}")});
  const SensorSurvey north = network.survey(0), south = network.survey(1);
  EXPECT_EQ(north.exposures.size(), north.frames);
  EXPECT_TRUE(south.exposures.empty());
  EXPECT_FALSE(north.passes.empty());
  for (const auto& pass : north.passes) {
    EXPECT_TRUE(std::isfinite(pass.log_miss) && pass.log_miss <= 0.0);
    EXPECT_TRUE(std::isfinite(pass.expected) && std::isfinite(pass.best_snr));
  }
}

TEST(SensorSurvey, UnderCloudsNothingIsDetected) {
  Network network(evening, {zenith_camera("thick", ", weather: {clouds: {transmission: 1e-5}}"),
                            zenith_camera("opaque", ", weather: {clouds: {transmission: 0}}"),
                            zenith_camera("clear")});
  EXPECT_LT(expected_of(network.survey(0)), 1e-3);
  EXPECT_EQ(expected_of(network.survey(1)), 0.0);
  EXPECT_GT(expected_of(network.survey(2)), 1.0);
}

TEST(SensorSurvey, WithoutObjectsExposuresAreEmpty) {
  Network network(evening, {zenith_camera("a")}, "[]");
  const SensorSurvey survey = network.survey();
  EXPECT_EQ(survey.exposures.size(), 90u);
  EXPECT_TRUE(survey.passes.empty());
}

TEST(SensorSurvey, ASaturatedSkyDetectsNothing) {
  Network network("{start: 2018-01-20T22:50:00Z, duration_s: 1200, tick_s: 10}",
                  {zenith_camera("a")});
  SurveyOptions by_day{.night_below_rad = 90.0 * deg};
  const SensorSurvey survey = survey_sensor(*network.scene, network.scenario.sensors[0],
                                            network.shells, network.threads, by_day);
  EXPECT_FALSE(survey.passes.empty());
  EXPECT_EQ(expected_of(survey), 0.0);
}

TEST(SensorSurvey, AnExposureLongerThanTheCadenceIsRefused) {
  try {
    Network network(evening, {"{name: a, site: atlanta, camera: omnissa, pointing: zenith, "
                              "exposure_s: 30, cadence_s: 20}"});
    FAIL() << "it was not refused";
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("exposure_s: must be <= cadence_s"), std::string::npos)
        << e.what();
  }
}

// METOP-A scans the shell above it; a sensor aboard an object does not see that object.
TEST(SensorSurvey, AnImagerInOrbitExposesDayAndNight) {
  Network network(evening,
                  {"{name: metop, platform: \"29499\", camera: wide-field-cmos, pointing: "
                   "{ra_deg: 85.2, dec_deg: 0.7}, exposure_s: 2, cadence_s: 15, sky: space}"});
  const SensorSurvey survey = network.survey();
  EXPECT_EQ(survey.exposures.size(), survey.frames);
  EXPECT_EQ(survey.without_state, 0u);
  EXPECT_FALSE(survey.exposures[0].sun_elevation_rad);
  EXPECT_FALSE(survey.passes.empty());
  for (const auto& pass : survey.passes)
    EXPECT_NE(network.scene->roster()->objects[pass.object].catalogue_number, 29499u);
}

TEST(SensorSurvey, MapAndPassesAndExposuresCountTheSame) {
  Network network(evening, {zenith_camera("a")});
  const SensorSurvey survey = network.survey();
  std::uint64_t looks = 0, of_passes = 0;
  double of_map = 0.0, expected = 0.0;
  for (const auto& [key, cell] : survey.map) {
    looks += cell.looks;
    of_map += double(cell.expected) * map_unit;
  }
  for (const auto& pass : survey.passes) {
    of_passes += pass.exposures;
    expected += pass.expected;
  }
  EXPECT_EQ(looks, of_passes);
  EXPECT_NEAR(of_map, expected, 1e-6 * double(looks));
  EXPECT_NEAR(expected, expected_of(survey), 1e-9 * expected);
}

// The Moon sets 2 h 20 min 29 s after midnight (astropy 5.2, upper limb without refraction; with it
// some minutes later): until then a camera that shuts for a Moon anywhere sees nothing.
TEST(SensorSurvey, OfAClosedShutterHasNothingInIt) {
  const std::string evening = "{start: 2018-01-21T02:10:00Z, duration_s: 1800, tick_s: 10}";
  std::string shutting = zenith_camera("a");
  const std::string band = "width_m: 0.128e-6}";
  shutting.insert(shutting.find(band) + band.size(),
                  ", exclusion: {moon_deg: 180, action: close_shutter}");
  Network plain(evening, {zenith_camera("a")}), closed(evening, {shutting});
  const SensorSurvey all = plain.survey(), left = closed.survey();
  ASSERT_EQ(left.exposures.size(), all.exposures.size());
  EXPECT_EQ(all.closed, 0u);
  std::uint32_t dark = 0;
  for (std::size_t k = 0; k < all.exposures.size(); ++k) {
    SurveyExposure e = left.exposures[k];
    const double until_s = e.middle.seconds() - 5.0 - 628.95;  // from the set to its begin
    if (until_s < 0.0 || until_s > 300.0) {
      EXPECT_EQ(e.in_field, until_s < 0.0 ? 0u : all.exposures[k].in_field) << k;
      EXPECT_EQ(e.expected, until_s < 0.0 ? 0.0 : all.exposures[k].expected) << k;
    }
    dark += e.in_field == 0 && e.expected == 0.0 && all.exposures[k].in_field > 0;
  }
  EXPECT_GT(left.closed, 31u);
  EXPECT_LT(left.closed, 31u + 16u);
  EXPECT_GT(dark, 0u);
  EXPECT_LT(expected_of(left), expected_of(all));
}

}  // namespace
}  // namespace dmise
