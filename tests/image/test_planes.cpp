#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numeric>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/image/fits_cards.h"
#include "core/image/fits_file.h"
#include "core/image/plane_file.h"
#include "core/pictures/picture_file.h"
#include "tests/image/sample_frame.h"
#include "tests/support/command.h"
#include "tests/support/data.h"
#include "tests/support/full_disk.h"

namespace dmise {
namespace {

using test::command_output;
using test::encoded;
using test::sample_counts;
using test::sample_header;
using testing::HasSubstr;

std::string scratch(const std::string& name) { return testing::TempDir() + "/planes-" + name; }

FlagImage sample_flags(int columns = 200, int rows = 150) {
  FlagImage flags(columns, rows);
  for (std::size_t i = 0; i < flags.pixels.size(); i += 37) flags.pixels[i] = std::uint8_t(i % 128);
  return flags;
}

ExpectedElectronImage sample_plane(int columns = 200, int rows = 150) {
  ExpectedElectronImage image(columns, rows);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = 1000.0f + float(i % 977) / 7.0f;
  return image;
}

Plane as_plane(const ExpectedElectronImage& image) {
  return {"SOURCES", "electron/s", "expected", image.pixels, image.columns};
}

double sum_of(const auto& pixels) { return std::accumulate(pixels.begin(), pixels.end(), 0.0); }

std::string number(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", v);
  return text;
}

TEST(FlagsInFits, DoNotChangeWhatADetectorReads) {
  const auto flags = sample_flags();
  for (const auto compression : {FitsCompression::none, FitsCompression::rice}) {
    const auto header = as_in_file(sample_header());
    const std::string bytes = encoded(sample_counts(), header, compression, &flags);
    const Frame frame = decode_frame(bytes, "frame.fits");
    EXPECT_EQ(frame.counts.pixels, sample_counts().pixels);
    EXPECT_EQ(frame.header, header);
    EXPECT_EQ(bytes, encoded(sample_counts(), header, compression, &flags));
  }
  const FlagImage other(3, 3);
  EXPECT_THROW(encoded(sample_counts(), sample_header(), FitsCompression::none, &other), Error);
}

// Reference: fitsverify 4.20 (HEASARC).
TEST(Planes, FitsverifyFindsNothing) {
  if (std::system("command -v fitsverify > /dev/null") != 0) DMISE_SKIP() << "needs fitsverify";
  const auto flags = sample_flags();
  const std::string frame = scratch("frame.fits"), plane = scratch("plane.fits");
  for (const auto compression : {FitsCompression::none, FitsCompression::rice}) {
    write_frame(frame, sample_counts(), sample_header(), compression, &flags);
    write_plane(plane, as_plane(sample_plane()), sample_header());
    for (const auto& path : {frame, plane}) {
      const auto [status, output] = command_output("fitsverify " + path);
      EXPECT_EQ(status, 0) << output;
      EXPECT_THAT(output, HasSubstr("0 warning(s) and 0 error(s)"));
    }
  }
}

// Reference: astropy 5.2 through its own decoder of Rice's code.
TEST(Planes, AstropyReadsCompressedCountsFlagsAndPlanes) {
  const std::string python = "/usr/bin/python3";
  if (std::system((python + " -c 'import astropy.wcs' 2> /dev/null").c_str()) != 0)
    DMISE_SKIP() << "needs python3-astropy";
  auto counts = sample_counts();
  auto flags = sample_flags();
  std::uint32_t state = 1;  // half of the frame is nothing that can be compressed
  for (std::size_t i = counts.pixels.size() / 2; i + 1 < counts.pixels.size(); ++i) {
    state = state * 1664525u + 1013904223u;
    counts.pixels[i] = std::uint16_t(state >> 16);
    flags.pixels[i] = std::uint8_t(state >> 24);
  }
  const auto plane = sample_plane();
  write_frame(scratch("rice.fits"), counts, sample_header(), FitsCompression::rice, &flags);
  write_plane(scratch("sources.fits"), as_plane(plane), sample_header());
  const auto [status, output] =
      command_output(python + " " DMISE_SOURCE_DIR "/tests/reference/read_planes_with_astropy.py " +
                     scratch("rice.fits") + " " + scratch("sources.fits"));
  EXPECT_EQ(status, 0) << output;
  EXPECT_EQ(output, "counts 150 200 uint16 sum " + number(sum_of(counts.pixels)) +
                        " by RICE_1\nflags 150 200 uint8 sum " + number(sum_of(flags.pixels)) +
                        " full well / cosmic ray\nprnu 0.01 blooming True bits 14\n"
                        "plane SOURCES 150 200 float32 sum " +
                        number(sum_of(plane.pixels)) + " electron / s RA---TAN-SIP\n");
}

TEST(Planes, NoNanLeaves) {
  ExpectedElectronImage image = sample_plane();
  image.at(3, 0) = std::numeric_limits<float>::quiet_NaN();
  const std::string path = scratch("nan.fits");
  try {
    write_plane(path, as_plane(image), sample_header());
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.what(), path + ": FITS can't be written: SOURCES: not a finite number at pixel 3");
  }
  EXPECT_FALSE(test::exists(path));
}

TEST(Planes, FullDiskLeavesNoHalfFileAndIsNamed) {
  const ExpectedElectronImage image = sample_plane();
  const auto write = [&](const std::string& path) {
    if (path.ends_with("plane.fits")) write_plane(path, as_plane(image), sample_header());
    if (path.ends_with("map.exr"))
      write_exr(path, {.columns = 200, .rows = 150, .channels = {{"Y", image.pixels.data()}}});
    if (path.ends_with("frame.fits")) write_frame(path, sample_counts(), sample_header());
  };
  for (const char* name : {"full-plane.fits", "full-map.exr", "full-frame.fits"}) {
    const std::string path = scratch(name);
    std::remove(path.c_str());
    std::string said;
    try {
      const test::FullDisk disk(1000);
      write(path);
    } catch (const Error& e) {
      said = e.what();
    }
    EXPECT_THAT(said, HasSubstr(path + ": "));
    EXPECT_THAT(said, HasSubstr("can't be written: "));
    EXPECT_FALSE(test::exists(path));
  }
}

// CFITSIO makes its file anew: a limit on the size of files, small and just too small, stands for a
// full disk. (`tests/system/run_lock.py` fills a real one.)
TEST(Planes, ACompressedFrameThatDoesNotFitLeavesNothing) {
  const auto flags = sample_flags();
  const std::string path = scratch("too-large.fits");
  const auto write = [&] {
    write_frame(path, sample_counts(), sample_header(), FitsCompression::rice, &flags);
  };
  write();
  const auto size = std::filesystem::file_size(path);
  std::filesystem::remove(path);
  for (const auto most : {std::uintmax_t(100), size / 2, size - 1}) {
    std::string said;
    try {
      const test::FullDisk disk(most);
      write();
    } catch (const Error& e) {
      said = e.what();
    }
    EXPECT_EQ(said, path + ": can't be written: File too large") << most;
    EXPECT_FALSE(test::exists(path));
    EXPECT_FALSE(test::exists(path + ".partial"));
  }
}

}  // namespace
}  // namespace dmise
