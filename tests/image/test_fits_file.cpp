#include "core/image/fits_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "core/base/error.h"
#include "core/base/files/whole_file.h"
#include "core/base/units.h"
#include "core/image/fits_cards.h"
#include "core/wcs/wcs.h"
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
using testing::Not;

std::string scratch(const std::string& name) { return testing::TempDir() + "/fits-" + name; }

std::string error_of(std::string_view bytes) {
  try {
    decode_frame(bytes, "frame.fits");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

/// `bytes` with the card of `key` replaced.
std::string with_card(std::string bytes, const std::string& key, std::string card) {
  std::string start = key;
  start.resize(8, ' ');
  const auto at = bytes.find(start + "=");
  if (at == std::string::npos) throw Error("no card " + key);
  card.resize(80, ' ');
  return bytes.replace(at, 80, card);
}

TEST(FitsFile, ReadsBackWhatWasWritten) {
  for (const auto compression : {FitsCompression::none, FitsCompression::rice}) {
    const auto counts = sample_counts();
    const auto header = as_in_file(sample_header());
    const Frame frame = decode_frame(encoded(counts, header, compression), "frame.fits");
    EXPECT_EQ(frame.counts.columns, counts.columns);
    EXPECT_EQ(frame.counts.rows, counts.rows);
    EXPECT_EQ(frame.counts.pixels, counts.pixels);
    EXPECT_EQ(frame.header, as_in_file(header));
  }
}

// The worst that Rice's code can meet: nothing to compress. And much: one value.
TEST(FitsFile, RiceReadsBackNoiseAndFlatFrames) {
  CountImage counts(1500, 1100);
  std::uint32_t state = 1;
  for (auto& pixel : counts.pixels)
    pixel = std::uint16_t((state = state * 1664525u + 1013904223u) >> 16);
  for (const CountImage& image : {counts, CountImage(1500, 1100, 300), CountImage(1, 1, 7)}) {
    const auto bytes = encoded(image, sample_header(), FitsCompression::rice);
    EXPECT_EQ(decode_frame(bytes, "frame.fits").counts.pixels, image.pixels);
  }
}

TEST(FitsFile, HeaderInMemoryIsTheHeaderOfTheFile) {
  const auto header = sample_header();
  const Frame frame = decode_frame(encoded(sample_counts(), header), "frame.fits");
  EXPECT_EQ(frame.header, as_in_file(header));
  EXPECT_NEAR(frame.header.wcs.ra_rad, header.wcs.ra_rad, 1e-15);
  EXPECT_EQ(frame.header.seed, header.seed);
}

TEST(FitsFile, BeginsWithItsCards) {
  const auto counts = sample_counts();
  std::string begin;
  for (const std::string& card : frame_file_cards(counts, sample_header())) {
    EXPECT_EQ(card.size(), 80u) << card;
    begin += card;
  }
  EXPECT_THAT(encode_frame(counts, sample_header()), testing::StartsWith(begin + "END     "));
}

TEST(FitsFile, SpaceSensorHasNoSite) {
  auto header = sample_header();
  header.site.reset();
  header.wcs.order = 0;
  const Frame frame = decode_frame(encoded(sample_counts(), header), "frame.fits");
  EXPECT_FALSE(frame.header.site);
  EXPECT_EQ(frame.header.wcs.order, 0);
}

TEST(FitsFile, EqualFramesAreEqualBytesAndRiceIsSmaller) {
  for (const auto compression : {FitsCompression::none, FitsCompression::rice})
    EXPECT_EQ(encoded(sample_counts(), sample_header(), compression),
              encoded(sample_counts(), sample_header(), compression));
  EXPECT_LT(encoded(sample_counts(640, 480), sample_header(), FitsCompression::rice).size(),
            0.6 * encoded(sample_counts(640, 480), sample_header()).size());
}

FrameHeader header_with_refraction() {
  FrameHeader header = sample_header();
  header.wcs.projection = Projection::equidistant;
  header.wcs.refraction = WcsRefraction{.zenith = {0.0, -0.6, 0.8},
                                        .focal_length_px = 60.0,
                                        .pressure_hpa = 950.0,
                                        .temperature_c = 10.0,
                                        .humidity = 0.3,
                                        .wavelength_um = 0.7,
                                        .offset_x_px = 0.01,
                                        .offset_y_px = -0.02,
                                        .cell_px = 7.5};
  return header;
}

TEST(FitsFile, ARefractionComesBackAndItsTablesDoNotDisturb) {
  const FrameHeader header = header_with_refraction();
  for (const auto compression : {FitsCompression::none, FitsCompression::rice}) {
    const Frame frame = decode_frame(encoded(sample_counts(), header, compression), "x");
    EXPECT_EQ(frame.header.wcs, as_in_file(header).wcs);
    EXPECT_EQ(frame.header.wcs.projection, Projection::equidistant);
    EXPECT_EQ(frame.header.wcs.refraction, header.wcs.refraction);
    EXPECT_EQ(frame.counts.pixels, sample_counts().pixels);
  }
}

// Every row of the table of projections, as a lens and as the plane of a world coordinate system.
TEST(FitsFile, EveryProjectionIsReadBack) {
  for (std::size_t i = 0; i < Projection::rows().size(); ++i) {
    std::vector<double> coefficients(Projection::rows()[i].coefficients.size(), 1e-3);
    for (std::size_t k = 0; k < coefficients.size(); ++k) coefficients[k] *= double(k + 1) / 3;
    FrameHeader header = header_with_refraction();
    header.projection = Projection::make(i, coefficients);
    header.wcs.projection = header.projection.fits_plane();
    if (header.wcs.projection != header.projection) header.wcs.refraction->lens = header.projection;
    const Frame frame = decode_frame(encoded(sample_counts(), header), "x");
    EXPECT_EQ(frame.header.projection, header.projection) << header.projection.name();
    EXPECT_EQ(frame.header.wcs.projection, header.wcs.projection) << header.projection.name();
    EXPECT_EQ(frame.header.wcs.refraction, header.wcs.refraction) << header.projection.name();
  }
}

// Reference: fitsverify 4.20. The records of a table lookup share a keyword by their convention,
// which it warns of; nothing else may be found.
TEST(FitsFile, FitsverifyFindsNothingInLookupTablesButTheirRecords) {
  if (std::system("command -v fitsverify > /dev/null") != 0) DMISE_SKIP() << "needs fitsverify";
  const std::string path = scratch("lookup.fits");
  write_frame(path, sample_counts(), header_with_refraction());
  const auto [status, output] =
      command_output("fitsverify " + path + " | grep -v 'Keyword DP. is duplicated'");
  EXPECT_THAT(output, HasSubstr("6 warning(s) and 0 error(s)"));
  EXPECT_THAT(output, Not(HasSubstr("*** Warning")));
}

// Reference: fitsverify 4.20 (HEASARC), which knows the FITS standard.
TEST(FitsFile, FitsverifyFindsNothing) {
  if (std::system("command -v fitsverify > /dev/null") != 0) DMISE_SKIP() << "needs fitsverify";
  for (const auto compression : {FitsCompression::none, FitsCompression::rice}) {
    const std::string path = scratch("verify.fits");
    write_frame(path, sample_counts(), sample_header(), compression);
    const auto [status, output] = command_output("fitsverify " + path);
    EXPECT_EQ(status, 0) << output;
    EXPECT_THAT(output, HasSubstr("0 warning(s) and 0 error(s)"));
  }
}

// Reference: astropy 5.2 through its own FITS and WCS readers.
TEST(FitsFile, AstropyReadsHeaderAndPixels) {
  const std::string python = "/usr/bin/python3";
  if (std::system((python + " -c 'import astropy.wcs' 2> /dev/null").c_str()) != 0)
    DMISE_SKIP() << "needs python3-astropy";
  const std::string path = scratch("astropy.fits");
  write_frame(path, sample_counts(), sample_header());
  const auto [status, output] = command_output(
      python + " -W error " DMISE_SOURCE_DIR "/tests/reference/read_frame_with_astropy.py " + path);
  EXPECT_EQ(status, 0) << output;
  EXPECT_EQ(output,
            "shape 150 200 dtype uint16 corners 0 65535\n"
            "gain 0.35 seed 18446744073709551615 obs 2018-01-20T23:40:10.000\n"
            "frame icrs ctype RA---TAN-SIP DEC--TAN-SIP reference pixel 99.5 74.5\n");
}

// Reference: astropy 5.2's WCS with SIP. The directions are ours (core/wcs/wcs.h).
TEST(FitsFile, AstropysWcsIsOursToAThousandthOfAPixel) {
  const std::string python = "/usr/bin/python3";
  if (std::system((python + " -c 'import astropy.wcs' 2> /dev/null").c_str()) != 0)
    DMISE_SKIP() << "needs python3-astropy";
  const std::string path = scratch("wcs.fits"), list = scratch("wcs.txt");
  for (const double dec_rad : {0.6, -pi / 2 + 1e-9, 1.5}) {
    auto header = sample_header(3326, 2504);
    header.wcs.dec_rad = dec_rad;
    write_frame(path, CountImage(3326, 2504), header);
    std::string lines;
    for (int i = 0; i < 100; ++i) {
      const int column = i % 10, row = i / 10;
      const double x = 360.0 * column, y = 270.0 * row;
      const auto place = to_spherical(wcs_direction(header.wcs, {x, y}));
      char line[128];
      std::snprintf(line, sizeof line, "%.3f %.3f %.14g %.14g\n", x, y, place[0] / deg,
                    place[1] / deg);
      lines += line;
    }
    write_file_whole(list, lines);
    const auto [status, output] = command_output(
        python + " " DMISE_SOURCE_DIR "/tests/reference/wcs_with_astropy.py " + path + " " + list);
    EXPECT_EQ(status, 0) << output;
    EXPECT_LT(std::stod(output), 0.001) << dec_rad;
  }
}

TEST(FitsFile, ReadsBackWhatIsUnknownAndAMirrorImage) {
  FrameHeader header = sample_header();
  header.mirrored = true;
  for (const FrameFactName& named : frame_fact_names) header.unknown.add(named.fact);
  const std::string bytes = encoded(sample_counts(), header);
  EXPECT_EQ(decode_frame(bytes, "frame.fits").header, as_in_file(header));
  EXPECT_TRUE(decode_frame(bytes, "frame.fits").header.unknown.has(FrameFact::gain));
  for (const char* key : {"EXPTIME", "DATE-OBS", "DATE-AVG", "DATE-END", "PHOTZP", "EXTINCT"})
    EXPECT_EQ(bytes.find(std::string(key) + std::string(8 - std::string(key).size(), ' ') + "="),
              std::string::npos)
        << key;
  EXPECT_EQ(error_of(with_card(bytes, "UNKNOWN", "UNKNOWN = 'time colour'")),
            "frame.fits: UNKNOWN: holds a word that names no fact, got time colour");
}

TEST(FitsFile, ReadsBackInWhichSystemMagnitudesAre) {
  FrameHeader header = sample_header();
  for (const auto system : {MagnitudeSystem::vega, MagnitudeSystem::ab}) {
    header.magnitudes = {system, -0.38};
    const std::string bytes = encoded(sample_counts(), header);
    EXPECT_EQ(decode_frame(bytes, "frame.fits").header, as_in_file(header));
    EXPECT_EQ(error_of(with_card(bytes, "SUNCOL", "COMMENT")), "frame.fits: SUNCOL: is missing");
  }
  const std::string bytes = encoded(sample_counts(), sample_header());
  EXPECT_EQ(error_of(with_card(bytes, "MAGSYS", "MAGSYS  = 'STMAG'")),
            "frame.fits: MAGSYS: must be V-solar, Vega or AB, got STMAG");
}

TEST(FitsFile, NamesTheMissingOrWrongKeyword) {
  const std::string good = encoded(sample_counts(), sample_header());
  EXPECT_EQ(error_of(with_card(good, "EXPTIME", "COMMENT")), "frame.fits: EXPTIME: is missing");
  EXPECT_EQ(error_of(with_card(good, "GAIN", "GAIN    = -1")),
            "frame.fits: GAIN: must be > 0, got -1");
  EXPECT_EQ(error_of(with_card(good, "GAIN", "GAIN    = nan")),
            "frame.fits: GAIN: must be a finite number, got nan");
  EXPECT_THAT(error_of(with_card(good, "CTYPE1", "CTYPE1  = 'GLON-CAR'")),
              testing::AllOf(HasSubstr("frame.fits: CTYPE1: must be RA---TAN, -ARC, -ZEA, -STG"),
                             HasSubstr(", with or without -SIP, got GLON-CAR")));
  EXPECT_EQ(error_of(with_card(good, "A_ORDER", "A_ORDER = 99")),
            "frame.fits: A_ORDER: must be in 1..9");
  EXPECT_EQ(error_of(with_card(good, "BZERO", "BZERO   = 0")),
            "frame.fits: BZERO: must be 32768, got 0");
  EXPECT_EQ(error_of(with_card(good, "QAVG0", "QAVG0   = 9.0")),
            "frame.fits: QAVG0: the quaternion must have length 1, got 9.0");
  EXPECT_EQ(error_of(with_card(good, "NAXIS1", "NAXIS1  = 60000000000")).find("frame.fits: "), 0u);
  EXPECT_EQ(error_of(with_card(good, "NAXIS1", "NAXIS1  = 60000")).find("frame.fits: "), 0u);
  EXPECT_THAT(error_of(with_card(good, "NAXIS1", "NAXIS1  = 1" + std::string(40, '0'))),
              HasSubstr("frame.fits: NAXIS: says more data than a file holds"));
  EXPECT_EQ(error_of(with_card(good, "BITPIX", "BITPIX  = -32")),
            "frame.fits: BITPIX: must be 16, got -32");
}

// Times, their differences and those of rows are whole nanoseconds of 64 bits.
TEST(FitsFile, RefusesTimesWithoutBound) {
  FrameHeader header = sample_header();
  header.detector->row_time_us = 20;
  const std::string bytes = encoded(sample_counts(), header);
  EXPECT_EQ(decode_frame(bytes, "frame.fits").header, as_in_file(header));
  EXPECT_EQ(error_of(with_card(bytes, "ROWTIME", "ROWTIME = 1E300")),
            "frame.fits: ROWTIME: must be in [0, 1e5], got 1E300");
  EXPECT_EQ(error_of(with_card(bytes, "SIMT-BEG", "SIMT-BEG= -9223372036854775808")),
            "frame.fits: SIMT-BEG: must be >= -4e18, got -9223372036854775808");
  EXPECT_EQ(error_of(with_card(bytes, "SIMT-END", "SIMT-END= 9223372036854775807")),
            "frame.fits: SIMT-END: must be <= 4e18, got 9223372036854775807");
}

// CFITSIO divides by the sizes of tiles and blocks while it opens a compressed image, and makes
// whole numbers of texts and fractions.
TEST(FitsFile, RefusesTilesAndBlocksOfNoSize) {
  for (const std::string key : {"ZVAL1   =", "ZTILE1  ="})
    for (const std::string value : {"0", "'0'", "''", "0.5", "-3", "4294967296", ""}) {
      std::string bytes =
          encoded(sample_counts(16, 12), sample_header(16, 12), FitsCompression::rice);
      const std::size_t at = bytes.find(key);
      ASSERT_NE(at, bytes.npos);
      bytes.replace(at + key.size(), 21, std::string(21 - value.size(), ' ') + value);
      try {
        decode_frame(bytes, "hostile.fits");
        ADD_FAILURE() << key << value;
      } catch (const ConfigError& error) {
        EXPECT_EQ(error.what(),
                  "hostile.fits: " + key.substr(0, key.find(' ')) + ": must be a whole number > 0");
      }
    }
}

// A value of many digits overflows CFITSIO's message about it; other bytes than ASCII do too.
TEST(FitsFile, RefusesHeadersThatAreNoText) {
  for (const FitsCompression compression : {FitsCompression::none, FitsCompression::rice}) {
    const std::string good = encoded(sample_counts(16, 12), sample_header(16, 12), compression);
    EXPECT_NO_THROW(decode_frame(good, "good.fits"));
    for (const std::string& value :
         {std::string(60, '7'), std::string(60, char(0x8e)), "'" + std::string(58, 'd') + "'"}) {
      std::string bytes = good;
      bytes.replace(bytes.rfind("NAXIS1  =") + 10, value.size(), value);
      EXPECT_THROW(decode_frame(bytes, "hostile.fits"), ConfigError);
    }
  }
}

TEST(FitsFile, RefusesEveryTruncation) {
  for (const auto compression : {FitsCompression::none, FitsCompression::rice}) {
    const std::string good = encoded(sample_counts(), sample_header(), compression);
    for (std::size_t size = 0; size + 2880 <= good.size(); size += 2880)
      EXPECT_THAT(error_of(std::string_view(good).substr(0, size)), HasSubstr("frame.fits: "));
  }
  EXPECT_EQ(error_of("P5 640 480 255"), "frame.fits: SIMPLE: not a FITS file");
}

TEST(FitsFile, NamesTheFileThatCannotBeWritten) {
  const std::string path = "/nonexistent-directory/frame.fits";
  try {
    write_frame(path, sample_counts(), sample_header());
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(path));
  }
  auto header = sample_header();
  header.zero_point_mag = std::nan("");
  EXPECT_THROW(write_frame(scratch("nan.fits"), sample_counts(), header), Error);
  EXPECT_FALSE(test::exists(scratch("nan.fits")));
}

TEST(FitsFile, FullDiskLeavesNoHalfFrame) {
  std::remove(scratch("full.fits").c_str());
  {
    const test::FullDisk disk(1000);
    EXPECT_THROW(write_frame(scratch("full.fits"), sample_counts(), sample_header()), Error);
  }
  EXPECT_FALSE(test::exists(scratch("full.fits")));
}

}  // namespace
}  // namespace dmise
