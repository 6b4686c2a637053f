#include "core/camera_calibration/calibrate_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/camera_calibration/drawn_camera.h"

// tests/reference/calibrate.py has the statistics over many cameras that numpy and GalSim drew.
namespace dmise {
namespace {

using test::DrawnCamera;
using test::FrameDirectory;
using testing::Contains;
using testing::HasSubstr;

void expect_within(const CameraCalibration& camera, const std::string& key, double drawn) {
  const CameraQuantity* q = camera.find(key);
  ASSERT_TRUE(q) << key;
  ASSERT_TRUE(q->sigma) << key;
  EXPECT_NEAR(q->value, drawn, 4 * *q->sigma) << key;
  EXPECT_LT(*q->sigma, 0.1 * drawn) << key;
}

TEST(CalibrateCamera, MeasuresWhatWasDrawn) {
  DrawnCamera drawn;
  FrameDirectory frames;
  frames.add_all(drawn, "Bias Frame", "Flat Field");
  for (int i = 0; i < 2; ++i) frames.add(drawn, drawn.counts(2e5), "Flat Field", 100.0);
  const CameraCalibration camera = frames.calibrated();
  expect_within(camera, "detector.gain_e_per_dn", drawn.gain_e_per_dn);
  expect_within(camera, "detector.read_noise_e", drawn.read_noise_e);
  expect_within(camera, "detector.bias_dn", drawn.bias_dn);
  expect_within(camera, "detector.prnu_rms", drawn.prnu_rms);
  expect_within(camera, "detector.full_well_e", drawn.full_well_e);
  EXPECT_THAT(camera.notes, Contains(HasSubstr("is saturated")));
  EXPECT_EQ(camera.find("detector.column_noise_e")->origin, ValueOrigin::insignificant);
}

TEST(CalibrateCamera, SortsFramesWithoutCardsByExposureAndLevel) {
  DrawnCamera drawn;
  FrameDirectory frames;
  frames.add_all(drawn, "", "");
  const CameraCalibration camera = frames.calibrated();
  expect_within(camera, "detector.gain_e_per_dn", drawn.gain_e_per_dn);
  EXPECT_THAT(camera.notes, Contains(HasSubstr("no IMAGETYP: taken for a flat")));
}

TEST(CalibrateCamera, DividesCountsThatWerePadded) {
  DrawnCamera drawn{.gain_e_per_dn = 20.0, .read_noise_e = 30.0};
  FrameDirectory frames;
  DrawnCamera* camera = &drawn;
  const auto padded = [&](double light_e) {
    auto counts = camera->counts(light_e);
    for (double& v : counts) v *= 16;
    return counts;
  };
  for (int i = 0; i < 4; ++i) frames.add(drawn, padded(0.0), "BIAS", 0.0);
  for (int i = 0; i < 4; ++i) frames.add(drawn, padded(30000.0), "FLAT", 1.0);
  const CameraCalibration found = frames.calibrated();
  expect_within(found, "detector.gain_e_per_dn", 20.0);
  expect_within(found, "detector.bias_dn", 300.0);
}

TEST(CalibrateCamera, KeepsDefaultsWithANoteWhereFramesAreMissing) {
  DrawnCamera drawn;
  FrameDirectory frames;
  for (int i = 0; i < 3; ++i) frames.add(drawn, drawn.counts(0.0), "zero", 0.0);
  const CameraCalibration camera = frames.calibrated();
  EXPECT_EQ(camera.find("detector.gain_e_per_dn")->origin, ValueOrigin::assumed);
  EXPECT_THAT(camera.notes, Contains(HasSubstr("no flats")));
  EXPECT_THAT(camera.notes, Contains(HasSubstr("no darks")));
  EXPECT_THAT(to_yaml(camera), HasSubstr("gain_e_per_dn: 1  # assumed"));
}

TEST(CalibrateCamera, GainOfAMosaicIsNotThatOfItsColours) {
  DrawnCamera drawn;
  FrameDirectory frames;
  for (int i = 0; i < 4; ++i)
    frames.add(drawn, drawn.counts(0.0), "BIAS", 0.0, {test::card("BAYERPAT", "'RGGB'")});
  for (const double light_e : {5000.0, 20000.0})
    for (int i = 0; i < 4; ++i) {
      const auto bright = drawn.counts(light_e), faint = drawn.counts(0.3 * light_e);
      auto counts = bright;
      for (int y = 0; y < drawn.rows; ++y)
        for (int x = 0; x < drawn.columns; ++x) {
          const auto at = std::size_t(y * drawn.columns + x);
          if (x % 2 == 0 && y % 2 == 0) counts[at] = faint[at];
        }
      frames.add(drawn, counts, "FLAT", light_e / 1000, {test::card("BAYERPAT", "'RGGB'")});
    }
  const CameraCalibration camera = frames.calibrated();
  expect_within(camera, "detector.gain_e_per_dn", drawn.gain_e_per_dn);
  expect_within(camera, "detector.prnu_rms", drawn.prnu_rms);
}

TEST(CalibrateCamera, RefusesFramesOfDifferentSizesAndNone) {
  DrawnCamera drawn, smaller{.columns = 100};
  FrameDirectory frames;
  EXPECT_THROW(frames.calibrated(), ConfigError);
  frames.add(drawn, drawn.counts(0.0), "BIAS", 0.0);
  frames.add(smaller, smaller.counts(0.0), "BIAS", 0.0);
  try {
    frames.calibrated();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr("1.fits: NAXIS1: must be 128 by 96 as of the first frame, got 100 by 96"));
  }
}

TEST(FrameKind, IsReadAsCamerasWriteIt) {
  EXPECT_EQ(frame_kind_of("Bias Frame"), FrameKind::bias);
  EXPECT_EQ(frame_kind_of("zero"), FrameKind::bias);
  EXPECT_EQ(frame_kind_of("Dark Flat"), FrameKind::dark);
  EXPECT_EQ(frame_kind_of("SKYFLAT"), FrameKind::flat);
  EXPECT_EQ(frame_kind_of("object"), FrameKind::light);
  EXPECT_EQ(frame_kind_of(""), FrameKind::unknown);
}

}  // namespace
}  // namespace dmise
