// Exposures on command become frames and a journal, and the journal the same frames.
#include "sensors/observatory/observatory.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include "core/base/units.h"
#include "sensors/observatory/commanded_frames.h"
#include "sensors/observatory/taken_image.h"
#include "tests/observatory/manual_clock.h"
#include "tests/observatory/small_scenario.h"

namespace dmise {
namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return (std::ostringstream() << file.rdbuf()).str();
}

std::string new_directory(const std::string& name) {
  const std::string path = testing::TempDir() + "/" + name;
  std::filesystem::remove_all(path);
  std::filesystem::create_directories(path);
  return path;
}

struct Night {
  explicit Night(const std::string& name, const std::string& keys = {})
      : out(new_directory(name)),
        scenario(small_observatory(out + "/scenario.yaml", keys)),
        scene(load_scene(scenario, make_clock(scenario))),
        observatory(scenario, scene, "digest", out, {.readout_s = 0.0}, clock,
                    [](const std::string& reason) { ADD_FAILURE() << reason; }) {
    clock.set(1.0);
    observatory.use(0, [](const auto& d) { d.telescope.set_tracking(true, d.now); });
  }

  /// Until they are written and the last is delivered.
  void wait_for_frames(int count) {
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (observatory.frames_written() < count || state() != CameraState::idle) {
      ASSERT_LT(std::chrono::steady_clock::now(), patience);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  CameraState state() {
    CameraState state{};
    observatory.use(0, [&](const auto& d) { state = d.camera.state(d.now); });
    return state;
  }

  std::string out;
  Scenario scenario;
  ScenarioInputs scene;
  ManualClock clock;
  Observatory observatory;
};

TEST(Observatory, TheJournalMakesTheSameFrames) {
  Night night("observatory-night");
  night.observatory.start_exposure(0, 2.0);
  EXPECT_EQ(night.state(), CameraState::exposing);
  night.clock.set(3.5);
  night.wait_for_frames(1);
  night.observatory.use(0, [](const auto& d) {
    EXPECT_EQ(d.camera.image()->columns, 32);
    d.telescope.set_rates(0.01, 0.002, d.now);
  });
  night.observatory.start_exposure(0, 10.0);
  night.clock.set(8.0);
  night.observatory.abort_exposure(0);  // leaves no frame
  night.observatory.start_exposure(0, 10.0);
  night.clock.set(12.0);
  night.observatory.stop_exposure(0);  // after 4 s
  night.wait_for_frames(2);
  night.observatory.use(0, [](const auto& d) { d.telescope.set_tracking(false, d.now); });
  night.clock.set(20.0);
  night.observatory.start_exposure(0, 0.5);
  night.clock.set(21.0);
  night.wait_for_frames(3);

  const auto journal = read_night(night.out + "/night.jsonl", night.scenario);
  ASSERT_EQ(journal.size(), 3u);
  EXPECT_EQ(journal[0].length, sim_seconds(2));
  EXPECT_EQ(journal[1].length, sim_seconds(4));
  EXPECT_EQ(journal[1].pointing.longitude_rate_deg_per_s, 0.01);
  EXPECT_FALSE(journal[2].pointing.follows);

  const std::string again = new_directory("observatory-again");
  replay_night(night.scenario, night.scene, journal, "digest", again, 2,
               [](const CommandedExposure&) { return true; });
  for (const char* file : {"/night.jsonl", "/eye/frame-000001.fits", "/eye/frame-000002.fits",
                           "/eye/frame-000003.fits", "/eye/frames.jsonl", "/eye/detections.jsonl",
                           "/eye/truth.jsonl"}) {
    EXPECT_FALSE(bytes_of(night.out + file).empty() && std::string(file).ends_with(".fits"))
        << file;
    EXPECT_EQ(bytes_of(night.out + file), bytes_of(again + file)) << file;
  }
}

double mean_of(const CountImage& image) {
  double sum = 0.0;
  for (const std::uint16_t count : image.pixels) sum += count;
  return sum / double(image.pixels.size());
}

// A box of twice the width has about twice the light of the sky; behind a cover there are 100 DN of
// bias and, at 2 e-/DN, 10 s of 1 e-/s.
TEST(Observatory, FiltersFocusAndCoverChangeFramesThatAreMadeAgain) {
  Night night("observatory-filters");
  double t_s = 10.0;
  int frames = 0;
  const auto taken = [&](bool light = true) {
    night.observatory.start_exposure(0, 10.0, light);
    night.clock.set(t_s += 20.0);
    night.wait_for_frames(++frames);
    return night.observatory.of(0, [](const auto& d) { return mean_of(*d.camera.image()); });
  };
  const auto command = [&](const auto& work) {
    night.observatory.use(0, work);
    night.clock.set(t_s += 20.0);
  };
  const double dark_dn = 105.0, v_dn = taken() - dark_dn;
  EXPECT_GT(v_dn, 20.0);
  command([](const auto& d) { d.wheel.turn_to(2, d.now); });
  EXPECT_NEAR((taken() - dark_dn) / v_dn, 2.0, 0.3);
  EXPECT_NEAR(taken(false), dark_dn, 1.0);
  command([](const auto& d) { d.focuser.move_to(d.focuser.position(d.now) + 50, d.now); });
  taken();
  command([](const auto& d) { d.cover.close(d.now); });
  EXPECT_NEAR(taken(), dark_dn, 1.0);

  const auto journal = read_night(night.out + "/night.jsonl", night.scenario);
  ASSERT_EQ(journal.size(), 5u);
  EXPECT_EQ(journal[1].filter, 2);
  EXPECT_EQ(journal[3].focus_um, 50.0);
  EXPECT_TRUE(journal[2].dark && !journal[3].dark && journal[4].dark);
  const std::string again = new_directory("observatory-filters-again");
  replay_night(night.scenario, night.scene, journal, "digest", again, 1,
               [](const CommandedExposure&) { return true; });
  for (int frame = 1; frame <= frames; ++frame) {
    const std::string file = "/eye/frame-00000" + std::to_string(frame) + ".fits";
    EXPECT_EQ(bytes_of(night.out + file), bytes_of(again + file)) << file;
  }
  EXPECT_NE(bytes_of(again + "/eye/frame-000005.fits").find("DARK    =                    T"),
            std::string::npos);
}

TEST(Observatory, WhatMovesWaitsForTheShutterAndTheShutterForIt) {
  Night night("observatory-moves");
  night.observatory.use(0, [](const auto& d) { d.wheel.turn_to(1, d.now); });
  EXPECT_THROW(night.observatory.start_exposure(0, 1.0), DeviceError);
  night.clock.set(5.0);
  night.observatory.start_exposure(0, 100.0);
  night.observatory.use(0, [](const auto& d) {
    EXPECT_THROW(d.wheel.turn_to(0, d.now), DeviceError);
    EXPECT_THROW(d.focuser.move_to(0, d.now), DeviceError);
    EXPECT_THROW(d.cover.close(d.now), DeviceError);
  });
  night.observatory.abort_exposure(0);
  night.observatory.use(0, [](const auto& d) { EXPECT_NO_THROW(d.cover.close(d.now)); });
  EXPECT_THROW(night.observatory.start_exposure(0, 1.0), DeviceError);
}

// The telescope tells that it follows the stars, and stands where it was when its mount stopped.
TEST(Observatory, AStoppedMountAndAStuckShutterAreInTheFramesAndTheJournal) {
  Night night("observatory-malfunctions",
              "    malfunctions:\n"
              "      - {kind: stopped_mount, at_s: 100, for_s: 60}\n"
              "      - {kind: stopped_mount, at_s: 150, for_s: 50}\n"
              "      - {kind: stuck_shutter, at_s: 300, for_s: 10}\n");
  int frames = 0;
  const auto exposed_at = [&](double t_s) {
    night.clock.set(t_s);
    night.observatory.start_exposure(0, 1.0);
    night.clock.set(t_s + 2.0);
    night.wait_for_frames(++frames);
    return read_night(night.out + "/night.jsonl", night.scenario).back();
  };
  EXPECT_TRUE(exposed_at(90.0).pointing.follows);
  night.clock.set(100.0);
  const Horizontal there =
      night.observatory.of(0, [](const auto& d) { return d.telescope.horizontal_place(d.now); });
  for (const double t_s : {110.0, 190.0}) {
    const CommandedPointing pointing = exposed_at(t_s).pointing;
    EXPECT_FALSE(pointing.follows);
    EXPECT_NEAR(pointing.latitude_deg, there.elevation_rad / deg, 1e-9);
    EXPECT_TRUE(
        night.observatory.of(0, [](const auto& d) { return d.telescope.is_tracking(d.now); }));
  }
  EXPECT_TRUE(exposed_at(210.0).pointing.follows);
  EXPECT_TRUE(exposed_at(300.0).dark);
  EXPECT_FALSE(exposed_at(310.0).dark);
}

TEST(Observatory, ASlowDownloadDelaysTheImageAndNothingElse) {
  Night night("observatory-slow",
              "    malfunctions: [{kind: slow_download, at_s: 10, for_s: 10, download_s: 8}]\n");
  night.clock.set(10.0);
  night.observatory.start_exposure(0, 1.0);
  night.clock.set(18.9);
  EXPECT_EQ(night.state(), CameraState::reading);
  EXPECT_FALSE(night.observatory.of(0, [](const auto& d) { return d.camera.image_ready(); }));
  night.clock.set(19.1);
  night.wait_for_frames(1);
  EXPECT_TRUE(night.observatory.of(0, [](const auto& d) { return d.camera.image_ready(); }));
}

TEST(Observatory, RefusesExposuresBeyondTheScenarioAndWhileSlewing) {
  Night night("observatory-refusals");
  night.clock.set(28790.0);
  EXPECT_THROW(night.observatory.start_exposure(0, 60.0), DeviceError);
  night.observatory.use(0, [](const auto& d) { d.telescope.find_home(d.now); });
  night.clock.set(28795.0);
  EXPECT_NO_THROW(night.observatory.start_exposure(0, 1.0));
  Night other("observatory-slewing");
  other.observatory.use(0, [](const auto& d) {
    const Equatorial place = d.telescope.place(d.now);
    d.telescope.slew_to(Equatorial{place.ra_deg, 60.0}, d.now);
  });
  EXPECT_THROW(other.observatory.start_exposure(0, 1.0), DeviceError);
}

// Reference: astropy's TETE, tests/reference/places_of_date.py.
TEST(Observatory, PlacesOfDateAreAstropys) {
  const Night night("observatory-date");
  const std::pair<Equatorial, Equatorial> places[] = {
      {{69.0, 16.5}, {69.2601270224, 16.5337044603}},
      {{359.999, -60.0}, {0.2185920604, -59.9056098327}},
      {{10.0, 89.9}, {109.3170441693, 89.9822472228}}};
  const auto apart_arcsec = [](const Equatorial& a, const Equatorial& b) {
    return angle_rad(direction_of<Gcrs>(a), direction_of<Gcrs>(b)) / arcsec;
  };
  for (const auto& [icrs, of_date] : places) {
    EXPECT_LT(apart_arcsec(night.observatory.of_date(icrs, {}), of_date), 0.01);
    EXPECT_LT(apart_arcsec(night.observatory.icrs_of(of_date, {}), icrs), 0.01);
    EXPECT_LT(
        apart_arcsec(night.observatory.icrs_of(night.observatory.of_date(icrs, {}), {}), icrs),
        1e-5);
  }
}

// A part of a frame has a header of its own; the whole is the frame's file.
TEST(Observatory, ImagesAreFilesOfFits) {
  TakenImage image{CountImage(4, 3, 7), {2, 2, 5, 6, 4, 3}, {}};
  image.header.sensor = "eye";
  image.header.start_utc = "2018-01-21T00:30:00.000000Z";
  image.header.middle_utc = image.header.end_utc = image.header.start_utc;
  image.header.observation.ra_rad = image.header.observation.dec_rad = 0.5;
  const std::string part = fits_of(image, false);
  EXPECT_EQ(part.size() % 2880, 0u);
  for (const char* card :
       {"NAXIS1  =                    4", "XBINNING=                    2",
        "XORGSUBF=                    5", "DATE-OBS= '2018-01-21T00:30:00.000000'"})
    EXPECT_NE(part.find(card), std::string::npos) << card;
  EXPECT_EQ(part.find("CTYPE1"), std::string::npos);
  EXPECT_TRUE(is_whole({1, 1, 0, 0, 4, 3}, 4, 3));
  EXPECT_FALSE(is_whole({1, 1, 1, 0, 3, 3}, 4, 3));
  EXPECT_FALSE(is_whole({2, 2, 0, 0, 4, 3}, 4, 3));
}

}  // namespace
}  // namespace dmise
