// Frames written by astropy 5.2 (tests/reference/foreign_frames.py) are read as astropy reads them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numeric>
#include <sstream>

#include "core/base/error.h"
#include "core/base/files/fits_guard.h"
#include "core/base/files/text_file.h"
#include "core/base/units.h"
#include "core/image/fits_image.h"
#include "core/ingest/any_frame.h"
#include "core/ingest/standard_wcs.h"
#include "core/wcs/wcs.h"
#include "tests/support/command.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

/// Writes files of a kind and returns the lines that astropy says of them.
std::string with_astropy(const std::string& kind, const std::string& directory) {
  std::filesystem::create_directories(directory);
  const auto [status, output] = test::command_output("/usr/bin/python3 " DMISE_SOURCE_DIR
                                                     "/tests/reference/foreign_frames.py " +
                                                     kind + " " + directory);
  EXPECT_EQ(status, 0) << output;
  return output;
}

bool has_astropy() {
  return std::system("/usr/bin/python3 -c 'import astropy.wcs' 2> /dev/null") == 0;
}

TEST(WithAstropy, PixelsOfEachTypeAreTheSame) {
  if (!has_astropy()) DMISE_SKIP() << "needs python3-astropy";
  const std::string directory = testing::TempDir() + "/foreign-pixels";
  std::istringstream lines(with_astropy("pixels", directory));
  std::string name;
  double sum = 0, least = 0, most = 0;
  int files = 0;
  for (; lines >> name >> sum >> least >> most; ++files) {
    const std::string bytes = read_text_file(directory + "/" + name + ".fits");
    FitsImage image(bytes, name);
    std::vector<double> values;
    image.add_plane(0, values);
    double total = 0, low = INFINITY, high = -INFINITY;
    for (const double v : values) {
      if (std::isnan(v)) continue;
      total += v;
      low = std::min(low, v);
      high = std::max(high, v);
    }
    EXPECT_NEAR(total / sum, 1, 1e-8) << name;
    EXPECT_NEAR(low, least, 1e-8 * std::abs(least)) << name;
    EXPECT_NEAR(high, most, 1e-8 * std::abs(most)) << name;
  }
  EXPECT_EQ(files, 35);
}

TEST(WithAstropy, DirectionsOfEachFormOfAWcsAreTheSame) {
  if (!has_astropy()) DMISE_SKIP() << "needs python3-astropy";
  const std::string directory = testing::TempDir() + "/foreign-wcs";
  std::istringstream lines(with_astropy("wcs", directory));
  std::string name;
  double x = 0, y = 0, ra_deg = 0, dec_deg = 0;
  int places = 0;
  for (; lines >> name >> x >> y >> ra_deg >> dec_deg; ++places) {
    FrameNotes notes;
    const std::string bytes = read_text_file(directory + "/" + name + ".fits");
    const FitsImage image(bytes, name);
    const auto wcs = wcs_of(StandardCards(image.values(), notes));
    ASSERT_TRUE(wcs) << name << ": " << notes.missing.at(0);
    const auto expected = from_spherical<Gcrs>(ra_deg * deg, dec_deg * deg);
    // Other frames: astropy precesses FK5 by IAU 2006, and the E-terms of FK4 differ over a field.
    const double most = name.starts_with("other-") ? 0.1 * arcsec : 1e-6 * arcsec + 1e-11;
    EXPECT_LT(angle_rad(wcs_direction(*wcs, {x, y}), expected), most) << name;
    // The camera that images so: its pixels agree in the middle of the frame.
    const CameraView view = view_of(*wcs, image.columns(), image.rows()).value();
    const PixelPosition middle{(image.columns() - 1) / 2.0, (image.rows() - 1) / 2.0};
    const auto v = view.camera_from_gcrs * wcs_direction(*wcs, middle + PixelPosition{2, 3});
    if (name == "crota" || name.starts_with("tpv")) continue;  // pixels are not square
    EXPECT_NEAR(v.x / v.z * view.focal_length_px, 2, 0.02) << name;
    EXPECT_NEAR(v.y / v.z * view.focal_length_px * (view.mirrored ? -1 : 1), 3, 0.02) << name;
  }
  EXPECT_EQ(places, 21 * 4);
}

// Unprintable bytes, long numbers, texts without an end, missing padding, bytes after the last HDU.
TEST(WithAstropy, FilesWithMangledHeadersAreReadWhereAstropyReadsThem) {
  if (!has_astropy()) DMISE_SKIP() << "needs python3-astropy";
  const std::string directory = testing::TempDir() + "/foreign-mangled";
  std::istringstream lines(with_astropy("mangled", directory));
  std::string name;
  double sum = 0;
  int files = 0;
  for (; lines >> name >> sum; ++files) {
    const std::string bytes = read_fits_file(directory + "/" + name + ".fits");
    try {
      FitsImage image(bytes, name);
      std::vector<double> values;
      image.add_plane(0, values);
      EXPECT_DOUBLE_EQ(std::accumulate(values.begin(), values.end(), 0.0), sum) << name;
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_GT(files, 350);
}

}  // namespace
}  // namespace dmise
