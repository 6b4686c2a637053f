#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/config/objects/sky_config.h"
#include "core/config/sensors/camera_config.h"
#include "core/config/sensors/optics_config.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/optics/projection.h"
#include "core/optics/psf_plan.h"

namespace dmise {
namespace {

const std::string plain =
    "columns: 64\nrows: 48\npixel_pitch_m: 5.0e-6\nfocal_length_m: 4\naperture_m: 0.4\n";

Optics read(const std::string& more) {
  return read_optics(YamlValue::parse(plain + more, "camera.yaml"));
}

std::string refusal(const std::string& more) {
  try {
    read(more);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(OpticsConfig, ReadsThePupilAndWhatBlurs) {
  const Optics o = read(
      "psf: diffraction\nzernike_nm: {4: 50, 7: -30}\nspiders: {count: 3, width_m: 0.01}\n"
      "defocus_m: 1.0e-4\njitter_arcsec: 0.1\nwavelengths: 5\noversampling: 4\nmethod: transform\n"
      "resampling: bilinear\npsf_grid: {columns: 3, rows: 3}\nfield_nm: {coma: 40}\n"
      "vignetting: {natural: true, corner: 0.6}\n");
  EXPECT_EQ(o.spread.model, PointSpread::Model::diffraction);
  ASSERT_EQ(o.spread.wavefront.size(), 2u);
  EXPECT_EQ(o.spread.wavefront[1].noll, 7);
  EXPECT_NEAR(o.spread.wavefront[1].rms_m, -30e-9, 1e-20);
  EXPECT_EQ(o.spread.spiders, 3);
  EXPECT_NEAR(o.spread.jitter_rad, 0.1 / 206264.806, 1e-12);
  EXPECT_EQ(o.spread.wavelengths, 5);
  EXPECT_EQ(o.spread.method, PointSpread::Method::transform);
  EXPECT_EQ(o.spread.grid_columns, 3);
  EXPECT_NEAR(o.spread.field.coma_m, 40e-9, 1e-20);
  EXPECT_TRUE(o.vignetting.natural);
}

// By hand: an image at 500 km lies focal length^2 / 500 km behind that of infinity.
TEST(OpticsConfig, TheDistanceOfFocusIsADefocusOfStars) {
  const double f_m = read("").focal_length_m;
  EXPECT_FALSE(std::isfinite(read("").spread.focus_distance_m));
  const Optics o = read("focus_distance_m: 500.0e+3\n");
  EXPECT_EQ(o.spread.focus_distance_m, 500e3);
  EXPECT_NEAR(o.spread.defocus_m, f_m * f_m / 500e3, 1e-15);
  const Optics both = read("psf: diffraction\ndefocus_m: -1.0e-5\nfocus_distance_m: 2.0e+5\n");
  EXPECT_NEAR(both.spread.defocus_m, f_m * f_m / 2e5 - 1e-5, 1e-15);
  for (const char* none : {"0", "-5", ".inf", ".nan", "near"})
    EXPECT_NE(refusal(std::string("focus_distance_m: ") + none + "\n").find("focus_distance_m: "),
              std::string::npos)
        << none;
  const auto planned = [&](const std::string& more) -> std::string {
    try {
      plan_psf(read(more), 0.55e-6, {}, 1.0);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(planned("focus_distance_m: 500.0e+3\n"), "");
  EXPECT_NE(planned("focus_distance_m: 0.01\n").find("optics.focus_distance_m: its disc of"),
            std::string::npos);
  EXPECT_NE(planned("focus_distance_m: 500.0e+3\nmethod: deposit\n").find("optics.method: deposit"),
            std::string::npos);
}

const std::string wide =
    "columns: 1000\nrows: 800\npixel_pitch_m: 5.0e-6\nfocal_length_m: 2.5e-3\naperture_m: 1e-4\n";

std::string refusal_of_wide(const std::string& more) {
  try {
    read_optics(YamlValue::parse(wide + more, "camera.yaml"));
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(OpticsConfig, ReadsTheCoefficientsOfAFisheye) {
  const Optics o = read("projection: kannala_brandt\ndistortion: {k1: -0.01, k3: 0.002}\n");
  EXPECT_EQ(o.projection, Projection(KannalaBrandt({-0.01, 0, 0.002, 0})));
  EXPECT_EQ(read("projection: kannala_brandt\n").projection, Projection(KannalaBrandt({})));
}

// By hand: r = theta - 0.4 theta^3 turns back at 1 / sqrt(1.2) rad, 52.3 deg; the frame's corner is
// at r = 1.28.
TEST(OpticsConfig, RefusesAFisheyeThatTurnsBackInTheFrame) {
  EXPECT_EQ(refusal_of_wide("projection: kannala_brandt\ndistortion: {k1: -0.4}\n"),
            "camera.yaml:1:1: distortion: the image folds back at 52.3 deg from the "
            "boresight, within the frame");
  EXPECT_EQ(refusal_of_wide("projection: kannala_brandt\ndistortion: {k1: -0.01}\n"), "");
  EXPECT_EQ(refusal("distortion: {k1: 0.1}\n")
                .find("camera.yaml:6:13: distortion: goes with projection: kannala_brandt"),
            0u);
  EXPECT_NE(refusal("projection: kannala_brandt\ndistortion: {k1: 2000}\n").find("k1: must be"),
            std::string::npos);
  EXPECT_NE(refusal("projection: kannala_brandt\ndistortion: {k5: 1}\n").find("unknown key"),
            std::string::npos);
  EXPECT_NE(refusal("projection: brown_conrady\ndistortion: {k4: 1}\n")
                .find("distortion.k4: goes with other keys or values than those given"),
            std::string::npos);
}

// By hand: the gnomonic place u on the row through the centre is imaged at u + k1 u^3 + 3 p2 u^2.
TEST(OpticsConfig, TheFieldAcrossTheColumnsIsThatOfTheWholeDistortion) {
  for (const double p2 : {-0.05, 0.05, 0.002, 0.0})
    for (const double k1 : {0.0, 0.1})
      for (const double field_deg : {0.01, 30.0, 100.0}) {
        const Optics o = read_optics(
            YamlValue::parse("columns: 1000\nrows: 2\npixel_pitch_m: 5.0e-6\naperture_m: 1.0e-5\n"
                             "projection: brown_conrady\nfield_of_view_deg: " +
                                 formatted("%g\ndistortion: {k1: %g, p2: %g}\n", field_deg, k1, p2),
                             "camera.yaml"));
        double sum_rad = 0.0;
        for (const double side : {-1.0, 1.0}) {
          double inside = 0.0, outside = 2.0;  // bounds of |u|
          for (int halving = 0; halving < 60; ++halving) {
            const double middle = 0.5 * (inside + outside), u = side * middle;
            const double image = u + k1 * u * u * u + 3 * p2 * u * u;
            const bool beyond = side * image * o.focal_length_m > 500 * o.pixel_pitch_m;
            (beyond ? outside : inside) = middle;
          }
          sum_rad += std::atan(inside);
        }
        EXPECT_NEAR(sum_rad / deg, field_deg, 1e-8 * field_deg) << p2 << " " << k1;
      }
}

// A field is imaged as it is asked for, or refused: on the row x' = u + 3 p2 u^2 turns back.
TEST(OpticsConfig, AFieldThatTheDistortionDoesNotImageIsRefused) {
  int refused = 0;
  for (const double p2 : {-1.0, -0.3, -0.1, 0.03, 0.1, 0.3, 1.0, 10.0})
    for (const double field_deg : {1.0, 60.0, 100.0, 150.0}) try {
        const Optics o = read_optics(
            YamlValue::parse("columns: 1000\nrows: 2\npixel_pitch_m: 5.0e-6\naperture_m: 1.0e-6\n"
                             "projection: brown_conrady\nfield_of_view_deg: " +
                                 formatted("%g\ndistortion: {p2: %g}\n", field_deg, p2),
                             "camera.yaml"));
        EXPECT_NEAR(field_across_rad(o, 500, 0) / deg, field_deg, 1e-5 * field_deg) << p2;
      } catch (const ConfigError& e) {
        EXPECT_NE(std::string(e.what()).find("the image folds back"), std::string::npos);
        ++refused;
      }
  EXPECT_GT(refused, 8);
  EXPECT_LT(refused, 28);
}

// By hand: r - 0.3 r^3 turns back at r = 1 / sqrt(0.9), 46.51 deg.
TEST(OpticsConfig, RefusesALensWhoseDistortionFoldsInTheFrame) {
  EXPECT_NE(refusal_of_wide("projection: brown_conrady\ndistortion: {k1: -0.3}\n")
                .find("distortion: the image folds back at 46.51 deg"),
            std::string::npos);
  EXPECT_EQ(refusal_of_wide("projection: brown_conrady\ndistortion: {k1: 0.1, p1: 1e-3}\n"), "");
  EXPECT_EQ(read("projection: brown_conrady\ndistortion: {k2: 0.1, p2: 1e-3}\n").projection,
            Projection(BrownConrady({0, 0.1, 0, 0, 1e-3})));
}

TEST(OpticsConfig, RefusesWhatDoesNotGoTogetherAtItsPlace) {
  EXPECT_EQ(refusal("psf: diffraction\npsf_fwhm_px: 2\n"),
            "camera.yaml:7:14: psf_fwhm_px: goes with psf: gaussian, got 2");
  EXPECT_EQ(refusal("jitter_px: 0.5\n").find("camera.yaml:6:12: jitter_px: goes with psf: "), 0u);
  EXPECT_NE(refusal("psf: diffraction\nzernike_nm: {3: 10}\n").find("4..66"), std::string::npos);
  EXPECT_NE(refusal("psf: diffraction\nzernike_nm: {four: 10}\n").find("4..66"), std::string::npos);
  EXPECT_NE(refusal("psf: diffraction\njitter_px: 1\njitter_arcsec: 1\n").find("give one of"),
            std::string::npos);
  EXPECT_NE(refusal("psf: diffraction\nfield_nm: {coma: 40}\n").find("psf_grid"),
            std::string::npos);
  EXPECT_NE(refusal("psf: airy\n").find("psf"), std::string::npos);
  EXPECT_NE(refusal("oversampling: 17\n").find("camera.yaml:6:15: oversampling"),
            std::string::npos);
  EXPECT_NE(refusal("vignetting: {corner: 0}\n").find("corner"), std::string::npos);
  const auto stray = [](const std::string& angles, const std::string& shares) {
    return refusal("stray_light: {angle_deg: " + angles + ", transmittance: " + shares + "}\n");
  };
  EXPECT_NE(stray("[30, 20]", "[0, 0]").find("angle_deg[1]: must rise, got 20"), std::string::npos);
  EXPECT_NE(stray("[30, 40]", "[0]")
                .find("transmittance: must have a number for each of the 2 of angle_deg"),
            std::string::npos);
  EXPECT_NE(stray("[30, 181]", "[0, 0]").find("angle_deg"), std::string::npos);
  EXPECT_NE(stray("[30, 40]", "[0, 1.1]").find("transmittance"), std::string::npos);
  EXPECT_NE(stray("[]", "[]").find("angle_deg"), std::string::npos);
  EXPECT_NE(refusal("psf: diffraction\nspider: 4\n").find("did you mean"), std::string::npos);
}

std::string refusal_of_camera(const std::string& optics, const std::string& band = "bessell-V") {
  try {
    read_camera(YamlValue::parse(
        "optics: {columns: 64, rows: 64, " + optics +
            "}\ndetector: {full_well_e: 50000, gain_e_per_dn: 2}\nband: " + band + "\n",
        "camera.yaml"));
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

// By hand: 0.5145 * 548.9 nm / 40 um is half of a width of 14.12 mrad, with a sigma of 5.997 mrad:
// 666 pixels of 9 urad.
TEST(CameraConfig, RefusesABlurThatIsWiderThanIsDrawn) {
  for (const char* psf : {"", ", psf: diffraction"})
    EXPECT_EQ(refusal_of_camera("pixel_pitch_m: 9e-6, focal_length_m: 1, aperture_m: 4.0e-5" +
                                std::string(psf)),
              "camera.yaml:1:85: optics.aperture_m: diffraction with this focal length and pixel "
              "pitch blurs to a sigma of 666 px, more than 500, got 4.0e-5");
  EXPECT_EQ(refusal_of_camera("pixel_pitch_m: 9e-6, focal_length_m: 1, aperture_m: 6.0e-5"), "");
}

TEST(CameraConfig, RefusesLengthsThatNothingCanBeComputedFrom) {
  EXPECT_EQ(refusal_of_camera("pixel_pitch_m: 1e-300, focal_length_m: 1, aperture_m: 0.1"),
            "camera.yaml:1:48: optics.pixel_pitch_m: must be >= 1e-12, got 1e-300");
  EXPECT_EQ(refusal_of_camera("pixel_pitch_m: 9e-6, focal_length_m: 1e300, aperture_m: 0.1"),
            "camera.yaml:1:70: optics.focal_length_m: must be <= 1e+06, got 1e300");
  const std::string usual = "pixel_pitch_m: 9e-6, focal_length_m: 1, aperture_m: 0.1";
  EXPECT_EQ(refusal_of_camera(usual, "{centre_m: 5.5e-7, width_m: 1e-300}"),
            "camera.yaml:3:35: band.width_m: must be >= 1e-18, got 1e-300");
  EXPECT_EQ(refusal_of_camera(usual, "{centre_m: 3.0e-5, width_m: 1e-18}"), "");
}

TEST(OpticsConfig, ReadsSeeing) {
  const SensorSeeing s = read_seeing(
      YamlValue::parse("{r0_m: 0.08, outer_scale_m: 25, wind_m_per_s: 12}", "scenario.yaml"), 1.0);
  EXPECT_EQ(s.r0_m, 0.08);
  EXPECT_EQ(s.outer_scale_m, 25.0);
  EXPECT_THROW(read_seeing(YamlValue::parse("{r0_m: 0}", "s.yaml"), 1.0), ConfigError);
  try {
    read_seeing(YamlValue::parse("{r0_m: 0.1, jet_wind_m_per_s: 30}", "s.yaml"), 1.0);
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_STREQ(e.what(),
                 "s.yaml:1:13: jet_wind_m_per_s: goes with other keys or values than those given");
  }
}

}  // namespace
}  // namespace dmise
