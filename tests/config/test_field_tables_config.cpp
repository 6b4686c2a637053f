#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/config/sensors/optics_config.h"
#include "core/config/yaml/yaml_reader.h"

// Tables over the field and the drift of the focus in a camera's file.
namespace dmise {
namespace {

const std::string plain =
    "columns: 64\nrows: 48\npixel_pitch_m: 5.0e-6\nfocal_length_m: 4\naperture_m: 0.4\n";

Optics read(const std::string& more) {
  return read_optics(YamlValue::parse(plain + more, "camera.yaml"));
}

void expect_refusal(const std::string& more, const std::string& text) {
  try {
    read(more);
    ADD_FAILURE() << more;
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
  }
}

TEST(FieldTablesConfig, ReadsAMeasuredVignetting) {
  const Optics o =
      read("vignetting: {radius_deg: [0, 10, 20], relative_illumination: [1, 0.9, 0]}\n");
  EXPECT_TRUE(o.vignetting.any());
  EXPECT_EQ(o.vignetting.table_radius, FieldRadius::angle_deg);
  EXPECT_DOUBLE_EQ(o.vignetting.table(10), 0.9);
  EXPECT_EQ(read("vignetting: {radius_px: [0, 30], relative_illumination: [1, 1]}\n")
                .vignetting.table_radius,
            FieldRadius::distance_px);
}

TEST(FieldTablesConfig, RefusesVignettingTablesThatAreNone) {
  const auto table = [](const std::string& radii, const std::string& light) {
    return "vignetting: {radius_deg: [" + radii + "], relative_illumination: [" + light + "]}\n";
  };
  expect_refusal(table("0, 20, 10", "1, 0.9, 0.8"), "vignetting.radius_deg[2]: must rise, got 10");
  expect_refusal(table("0, 10, 10", "1, 0.9, 0.8"), "must rise, got 10");
  expect_refusal(table("0, 10", "1, 1.1"), "relative_illumination[1]: must be");
  expect_refusal(table("0, 10", "1, -0.1"), "relative_illumination[1]: must be");
  expect_refusal(table("-1, 10", "1, 0.5"), "radius_deg[0]: must be");
  expect_refusal(table("0", "1"), "relative_illumination: needs two radii or more");
  expect_refusal(table("", ""), "needs a radius");
  expect_refusal(table("0, 10", "1, 0.9, 0.8"), "must have a number for each of the 2");
  expect_refusal(table("0, 10", "1, .nan"), "relative_illumination[1]");
  expect_refusal("vignetting: {relative_illumination: [1, 0.5]}\n",
                 "needs one of radius_deg and radius_px");
  expect_refusal("vignetting: {radius_px: [0, 1]}\n", "radius_px: needs relative_illumination");
  expect_refusal("vignetting: {natural: on, radius_px: [0, 9], relative_illumination: [1, 0.5]}\n",
                 "natural: can't stand beside relative_illumination");
}

TEST(FieldTablesConfig, ReadsABlurOverTheField) {
  const Optics widths =
      read("psf_field: {radius_px: [0, 40], fwhm_radial_px: [2, 5], fwhm_tangential_px: [2, 3]}\n");
  EXPECT_EQ(widths.psf_fwhm_px, 0.0);
  EXPECT_DOUBLE_EQ(widths.spread.varying.fwhm_tangential_px(40), 3.0);
  const Optics waves = read(
      "psf: diffraction\npsf_field: {radius_deg: [0, 1], zernike_nm: {4: [5, 9], 8: [0, 50]}}\n");
  ASSERT_EQ(waves.spread.varying.wavefront.size(), 2u);
  EXPECT_DOUBLE_EQ(waves.spread.varying.wavefront[1].rms_m(1), 50e-9);
}

TEST(FieldTablesConfig, RefusesABlurThatCannotBe) {
  expect_refusal("psf_field: {radius_px: [0, 9], zernike_nm: {4: [0, 1]}}\n",
                 "zernike_nm: goes with psf: diffraction");
  expect_refusal("psf: diffraction\npsf_field: {radius_px: [0, 9], fwhm_radial_px: [2, 3]}\n",
                 "fwhm_radial_px: goes with psf: gaussian");
  expect_refusal("psf_field: {radius_px: [0, 9]}\n", "needs fwhm_radial_px");
  expect_refusal("psf_fwhm_px: 2\npsf_field: {radius_px: [0], fwhm_radial_px: [3]}\n",
                 "psf_fwhm_px: can't stand beside psf_field");
  expect_refusal("psf_field: {radius_px: [9, 3], fwhm_radial_px: [3, 3]}\n",
                 "radius_px[1]: must rise, got 3");
  expect_refusal(
      "psf_field: {radius_px: [0, 9], fwhm_radial_px: [2, 3], fwhm_tangential_px: [3, 3]}\n",
      "must be that of fwhm_radial_px on the axis");
  expect_refusal("psf: diffraction\npsf_field: {radius_px: [0, 9], zernike_nm: {8: [5, 9]}}\n",
                 "must be 0 on the axis, which has no direction");
  expect_refusal("psf: diffraction\npsf_field: {radius_px: [0, 9], zernike_nm: {1: [5, 9]}}\n",
                 "psf_field.zernike_nm");
  expect_refusal(
      "psf: diffraction\npsf_grid: {columns: 3, rows: 3}\n"
      "psf_field: {radius_px: [0, 9], zernike_nm: {4: [5, 9]}}\n",
      "psf_grid: can't stand beside psf_field");
}

TEST(FieldTablesConfig, ReadsAFocusThatDrifts) {
  const Optics o = read("focus_drift: {um_per_hour: 3, um_per_k: -2, swing_k: 8}\n");
  EXPECT_TRUE(o.spread.drift.any());
  EXPECT_EQ(o.spread.drift.warmest_h, 14.0);
  EXPECT_FALSE(read("focus_drift: {um_per_k: -2}\n").spread.drift.any());
  expect_refusal("focus_drift: {swing_k: -1}\n", "focus_drift.swing_k");
  expect_refusal("focus_drift: {um_per_day: 1}\n", "unknown key");
}

}  // namespace
}  // namespace dmise
