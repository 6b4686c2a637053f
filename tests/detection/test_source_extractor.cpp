#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/detection/detect.h"
#include "core/image/fits_file.h"
#include "tests/support/data.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

struct Measured {
  double x_px, y_px, magnitude;
};

/// What SExtractor (Bertin & Arnouts 1996) finds: windowed centroids, magnitudes in an aperture of
/// 12 px that holds all of the light.
std::vector<Measured> by_source_extractor(const std::string& fits, const FrameHeader& header) {
  const std::string folder = testing::TempDir() + "/", catalogue = folder + "sextractor.txt";
  write_file_whole(folder + "sextractor.param", "XWIN_IMAGE\nYWIN_IMAGE\nFLUX_APER\nFLAGS\n");
  const std::string command =
      "cd " + folder + " && source-extractor " + fits +
      " -c /dev/null -PARAMETERS_NAME sextractor.param -CATALOG_NAME " + catalogue +
      " -CATALOG_TYPE ASCII -FILTER N -DETECT_THRESH 3 -ANALYSIS_THRESH 3 -PHOT_APERTURES 12"
      " -BACK_SIZE 64 -VERBOSE_TYPE QUIET -WEIGHT_TYPE NONE > /dev/null 2>&1";
  if (std::system(command.c_str()) != 0) return {};
  std::istringstream lines(read_text_file(catalogue));
  std::vector<Measured> out;
  double x, y, flux_dn;
  int flags;
  while (lines >> x >> y >> flux_dn >> flags)
    if (flags == 0 && flux_dn > 0)
      out.push_back({x - 1, y - 1,
                     header.zero_point_mag -
                         2.5 * std::log10(flux_dn * header.gain_e_per_dn / header.exposure_s)});
  return out;
}

// Points where stars trail, so that they are published.
TEST(SourceExtractor, AgreesOnPlacesAndMagnitudes) {
  if (std::system("command -v source-extractor > /dev/null") != 0)
    DMISE_SKIP() << "needs source-extractor";
  const auto header = simulated::camera_header(1000, 1000, 1663, 34 * deg, 20, true);
  simulated::SimulatedFrame frame(header, 1000, 1000, 1500, 12);
  for (int i = 0; i < 225; ++i)
    frame.add_point(40 + 65 * (i % 15) + frame.uniform(-.5, .5),
                    40 + 65 * (i / 15) + frame.uniform(-.5, .5),
                    std::pow(10, frame.uniform(4.0, 4.7)));
  const CountImage counts = frame.expose();
  const std::string fits = testing::TempDir() + "/sextractor.fits";
  write_frame(fits, counts, header);
  Threads threads;
  const auto ours = detect(counts, header, {}, threads).detections;
  const auto theirs = by_source_extractor(fits, header);
  ASSERT_GT(theirs.size(), 200u);
  int pairs = 0;
  double dx = 0, dy = 0, square = 0, dm = 0, dm_square = 0;
  for (const Measured& m : theirs)
    for (const Detection& d : ours) {
      const double ex = d.x_px - m.x_px, ey = d.y_px - m.y_px;
      if (std::hypot(ex, ey) > 2) continue;
      ++pairs;
      dx += ex;
      dy += ey;
      square += ex * ex + ey * ey;
      dm += d.magnitude - m.magnitude;
      dm_square += std::pow(d.magnitude - m.magnitude, 2);
    }
  EXPECT_GT(pairs, 200);
  EXPECT_NEAR(dx / pairs, 0.0, 0.005);
  EXPECT_NEAR(dy / pairs, 0.0, 0.005);
  EXPECT_LT(std::sqrt(square / pairs), 0.05);
  EXPECT_NEAR(dm / pairs, 0.0, 0.01);
  EXPECT_LT(std::sqrt(dm_square / pairs), 0.05);
}

}  // namespace
}  // namespace dmise
