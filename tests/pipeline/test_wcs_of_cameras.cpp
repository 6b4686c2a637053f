#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "core/base/units.h"
#include "core/image/fits_cards.h"
#include "core/image/fits_file.h"
#include "core/optics/projection.h"
#include "core/wcs/wcs.h"
#include "sensors/frame/header_of.h"
#include "sensors/scene/view.h"
#include "tests/pipeline/harness.h"
#include "tests/support/projections.h"

// The header's WCS, read by astropy, against the camera: catalogue directions through proper ERFA
// places, refraction and projection forward, as stars are drawn. All default effects.
namespace dmise {
namespace {

// GOES 16, an element set of 2018-01-19 as in `catalogue: demo`.
const std::string elements =
    "GOES 16\n"
    "1 41866U 16071A   18019.87773469 -.00000245  00000-0  00000-0 0  9992\n"
    "2 41866   0.0069 115.0916 0001074 269.6956 335.2025  1.00271237  4322\n";

struct CameraCase {
  std::string projection;
  double field_deg;
  std::string place, pointing;
  int columns = 1024, rows = 768;
  bool by_wcsmax = false;  // held to WCSMAX alone: sees sky almost opposite to the axis, where no
                           // plane is smooth, or is bent more than SIP can hold
};

/// The Sun bends light by up to 1.75 arcsec in a spot that no fit looks at.
constexpr double at_the_sun_px = 0.003;

std::string text(const CameraCase& c) {
  std::ostringstream s;
  s << c.projection << " " << c.field_deg << " deg, " << c.columns << " x " << c.rows << ", "
    << c.place << ", " << c.pointing;
  return s.str();
}

std::string scenario(const CameraCase& c) {
  std::ostringstream s;
  s.precision(17);
  s << "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 30, tick_s: 5}\n"
    << "objects: [{catalogue: objects.tle}]\n"
    << "sensors:\n  - {name: eye, " << c.place << ", camera: {optics: {projection: " << c.projection
    << ", columns: " << c.columns << ", rows: " << c.rows
    << ", pixel_pitch_m: 5e-6, field_of_view_deg: " << c.field_deg
    << ", aperture_m: 0.1, equivalent_aperture: on, psf_fwhm_px: 1.5}, detector: {full_well_e: "
       "20000,"
    << " gain_e_per_dn: 1, read_noise_e: 5}, band: {centre_m: 0.55e-6, width_m: 0.1e-6}}, "
       "pointing: "
    << c.pointing << ", exposure_s: 1, cadence_s: 10}\n";
  return s.str();
}

/// What astropy is asked: pixels that see sky, and the catalogue directions seen there.
struct Asked {
  FrameHeader header;
  std::string lines;
  int count = 0;
  double worst_here_px = 0.0;  // error of core/wcs/wcs.h
};

Asked ask(const CameraCase& c) {
  test::Stage stage(scenario(c), "", elements);
  const auto& config = stage.scenario.sensors.at(0);
  const PipelineSettings settings{.sensor = config, .clock = make_clock(stage.scenario)};
  const View view(config, frame_times(config, 1), stage.states);
  const SimTime middle = view.times().middle;
  Asked asked{.header = as_in_file(header_of(view, settings, 1.5)), .lines = {}};
  const auto places = view.places(middle);
  const auto gcrs_from_camera = view.camera_from_gcrs(middle).inverse();
  // The star that is somewhere near a pixel, imaged forward.
  const int points = 80;
  for (int j = 0; j <= points; ++j)
    for (int i = 0; i <= points; ++i) {
      const auto rough = unproject(config.camera.optics, {-0.5 + c.columns * double(i) / points,
                                                          -0.5 + c.rows * double(j) / points});
      if (!rough) continue;
      const auto [ra, dec] = to_spherical(places.star_seen_at(gcrs_from_camera * *rough));
      const Vec<Gcrs> apparent =
          places.star({.ra_rad = ra, .dec_rad = dec, .epoch_jyear = 2018.06});
      if (view.on_ground() && dot(apparent, view.up(middle)) < 0.0) continue;
      const auto pixel = test::pixel_of(view, apparent, middle);
      if (!pixel || std::abs(pixel->x_px + 0.5 - 0.5 * c.columns) > 0.5 * c.columns ||
          std::abs(pixel->y_px + 0.5 - 0.5 * c.rows) > 0.5 * c.rows)
        continue;
      char line[128];
      std::snprintf(line, sizeof line, "%.9f %.9f %.16g %.16g\n", pixel->x_px, pixel->y_px,
                    ra / deg, dec / deg);
      asked.lines += line;
      ++asked.count;
      const auto here = wcs_pixel(asked.header.wcs, from_spherical<Gcrs>(ra, dec));
      asked.worst_here_px = std::max(
          asked.worst_here_px,
          here ? std::hypot(here->x_px - pixel->x_px, here->y_px - pixel->y_px) : HUGE_VAL);
    }
  return asked;
}

class WcsOfCameras : public testing::TestWithParam<test::ProjectionCase> {
 protected:
  static std::vector<CameraCase> cases(const test::ProjectionCase& lens) {
    const std::string& projection = lens.yaml;
    std::vector<CameraCase> all;
    const std::vector<std::string> pointings = {"zenith", "{azimuth_deg: 200, elevation_deg: 45}",
                                                "{azimuth_deg: 10, elevation_deg: 2}",
                                                "{ra_deg: 123, dec_deg: 90}"};
    for (const double field : {0.01, 1.0, 5.0, 20.0, 45.0, 90.0, 120.0, 150.0, 168.0, 182.0})
      for (const auto& pointing : pointings)
        if (field <= lens.fields_to_deg)
          all.push_back({projection, field, "site: atlanta", pointing});
    const double widest = lens.widest_deg;
    all.push_back({projection, widest, "site: atlanta", "{azimuth_deg: 10, elevation_deg: -20}",
                   500, 700, projection == "equisolid"});
    all.push_back({projection, widest, "platform: \"41866\"", "{ra_deg: 123, dec_deg: -90}"});
    all.push_back({projection, 60, "platform: \"41866\"", "{ra_deg: 0, dec_deg: 10}"});
    all.push_back({projection, 60, "site: atlanta", "{azimuth_deg: 10, elevation_deg: 20}", 1, 1});
    all.push_back(
        {projection, 60, "site: atlanta", "{azimuth_deg: 10, elevation_deg: 20}", 4096, 1});
    all.push_back(
        {projection, 0.05, "site: atlanta", "{azimuth_deg: 10, elevation_deg: 20}", 1, 900});
    all.push_back({projection, widest, "site: atlanta", "zenith", 4096, 4096});
    for (const auto& pointing : pointings)
      if (widest < 90) all.push_back({projection, 90, "site: atlanta", pointing, 1024, 768, true});
    return all;
  }
};

// Reference: astropy 5.2 (wcslib, SIP and table lookup).
TEST_P(WcsOfCameras, AstropyAgreesWithinTheStatedErrorWhereverSkyIsSeen) {
  const std::string python = "/usr/bin/python3";
  if (std::system((python + " -c 'import astropy.wcs' 2> /dev/null").c_str()) != 0)
    GTEST_SKIP() << "needs python3-astropy";
  const auto directory = std::filesystem::path(testing::TempDir()) /
                         ("wcs-of-cameras-" + std::string(GetParam().name));
  std::filesystem::create_directories(directory);
  const auto all = cases(GetParam());
  std::vector<Asked> asked;
  std::string command = python + " " DMISE_SOURCE_DIR "/tests/reference/wcs_with_astropy.py";
  for (const CameraCase& c : all) {
    asked.push_back(ask(c));
    ASSERT_GT(asked.back().count, 0) << text(c);
    const std::string base = (directory / std::to_string(asked.size())).string();
    write_frame(base + ".fits", CountImage(c.columns, c.rows), asked.back().header,
                FitsCompression::rice);
    std::ofstream(base + ".txt") << asked.back().lines;
    command += " " + base + ".fits " + base + ".txt";
  }
  FILE* pipe = popen(command.c_str(), "r");
  ASSERT_TRUE(pipe);
  for (std::size_t i = 0; i < all.size(); ++i) {
    double worst_px = HUGE_VAL;
    ASSERT_EQ(std::fscanf(pipe, "%lf", &worst_px), 1) << text(all[i]);
    const Wcs& wcs = asked[i].header.wcs;
    if (std::getenv("DMISE_SHOW"))
      std::printf("%-90s %s%s astropy %.4f here %.4f WCSMAX %.4f cell %.1f\n", text(all[i]).c_str(),
                  wcs.projection.row().fits_code, wcs.order ? "-SIP" : "", worst_px,
                  asked[i].worst_here_px, wcs.max_px,
                  wcs.refraction ? wcs.refraction->cell_px : 0.0);
    EXPECT_LE(worst_px, std::max(wcs.max_px, at_the_sun_px)) << text(all[i]);
    EXPECT_LE(asked[i].worst_here_px, std::max(wcs.max_px, at_the_sun_px)) << text(all[i]);
    if (all[i].by_wcsmax) continue;
    EXPECT_LE(worst_px, 0.1) << text(all[i]);
    EXPECT_LE(wcs.max_px, 0.15) << text(all[i]);
  }
  pclose(pipe);
  std::filesystem::remove_all(directory);
}

INSTANTIATE_TEST_SUITE_P(Projections, WcsOfCameras, testing::ValuesIn(test::every_projection),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace dmise
