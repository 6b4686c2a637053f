#include "core/image/fits_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>

#include "core/base/error.h"
#include "tests/ingest/foreign_file.h"
#include "tests/support/config_error.h"

// Files are written by CFITSIO 4.2, and in tests/reference/foreign_frames.py by astropy.
namespace dmise {
namespace {

using test::ForeignImage;
using testing::HasSubstr;

constexpr int columns = 70, rows = 40;

/// Values that bytes hold, too: different in neighbours.
std::vector<double> ramp(int planes = 1, double step = 1.0) {
  std::vector<double> values;
  for (int i = 0; i < columns * rows * planes; ++i) values.push_back(step * (i * 37 % 251));
  return values;
}

std::vector<double> read(const std::string& bytes, int plane = 0) {
  FitsImage image(bytes, "frame.fits");
  EXPECT_EQ(image.columns(), columns);
  EXPECT_EQ(image.rows(), rows);
  std::vector<double> values;
  image.add_plane(plane, values);
  return values;
}

std::string error_of(const std::string& bytes) {
  return test::config_error_of([&] { FitsImage(bytes, "frame.fits"); });
}

TEST(FitsImage, ReadsEachKindOfPixel) {
  for (const int bitpix :
       {BYTE_IMG, SHORT_IMG, USHORT_IMG, LONG_IMG, ULONG_IMG, LONGLONG_IMG, FLOAT_IMG, DOUBLE_IMG})
    for (const bool in_extension : {false, true})
      EXPECT_EQ(read(encoded(ForeignImage{.bitpix = bitpix,
                                          .shape = {columns, rows},
                                          .values = ramp(),
                                          .in_extension = in_extension})),
                ramp())
          << bitpix;
}

TEST(FitsImage, ScalesByBscaleAndBzero) {
  const auto values = read(encoded(ForeignImage{.bitpix = LONG_IMG,
                                                .shape = {columns, rows},
                                                .values = ramp(1, 0.25),
                                                .bscale = 0.25,
                                                .bzero = -10}));
  EXPECT_EQ(values, ramp(1, 0.25));
}

/// A file with one more card, before END.
std::string with_card(std::string bytes, std::string card) {
  card.resize(80, ' ');
  const std::string end = "END" + std::string(77, ' ');
  bytes.replace(bytes.find(end), 160, card + end);
  return bytes;
}

TEST(FitsImage, ReadsHeadersThatAreNotPrintableAndNamesTheirCards) {
  const std::string good = encoded(ForeignImage{.shape = {columns, rows}, .values = ramp()});
  for (const auto& [card, note] : std::vector<std::pair<std::string, std::string>>{
           {"CCD-TEMP=                -10.0 / chip temperature, \xb0"
            "C",
            "CCD-TEMP: bytes"},
           {"OBSERVER= 'Pe\xc3\xb1"
            "a'",
            "OBSERVER: bytes"},
           {"HISTORY made\twith a tab", "HISTORY: bytes"},
           {std::string("COMMENT a\0byte", 14), "COMMENT: bytes"},
           {"BZERO   = 0." + std::string(40, '0'), "BZERO: a long number"},
           {"SKEW    = (1.0, 2.0)           / complex", ""},
           {"COMMENT ========================= camera =========================", ""},
           {"LONGNUM = 3.14159265358979323846264338327950288419716939937510", ""}}) {
    const std::string bytes = with_card(good, card);
    EXPECT_EQ(read(bytes), ramp()) << card;
    const FitsImage image(bytes, "frame.fits");
    ASSERT_EQ(image.mended().size(), note.empty() ? 0u : 1u) << card;
    if (!note.empty()) {
      EXPECT_THAT(image.mended()[0], HasSubstr(note));
    }
  }
}

TEST(FitsImage, ReadsFilesWithoutTheirLastPaddingOrWithBytesAfterTheirLastHdu) {
  const std::string good = encoded(ForeignImage{.shape = {columns, rows}, .values = ramp()});
  const std::size_t end = good.size() / 2880 * 2880 - 2880 + columns * rows * 2 % 2880;
  for (const std::string& bytes :
       {good.substr(0, end), good.substr(0, end + 1), good + std::string(2880, '\0'), good + "x",
        good + std::string(5760, '~')}) {
    EXPECT_EQ(read(bytes), ramp());
    EXPECT_EQ(FitsImage(bytes, "frame.fits").mended().size(), 1u);
  }
  EXPECT_THAT(error_of(good.substr(0, end - 1)), HasSubstr("frame.fits: is truncated"));
}

// 3 MB of gzip hold 3 GB of zeros: no more is unpacked than the headers ask for, and a block.
TEST(FitsImage, UnpacksNoMoreOfAFileThanItsHeadersAskFor) {
  const std::string good = encoded(ForeignImage{.shape = {columns, rows}, .values = ramp()});
  const std::string path = testing::TempDir() + "/bomb.fits.gz";
  gzFile file = gzopen(path.c_str(), "wb1");
  gzwrite(file, good.data(), unsigned(good.size()));
  const std::string zeros(1 << 20, '\0');
  for (int i = 0; i < 64; ++i) gzwrite(file, zeros.data(), unsigned(zeros.size()));
  gzclose(file);
  const std::string bytes = read_fits_file(path);
  EXPECT_EQ(bytes.size(), good.size() + 2880);
  EXPECT_EQ(read(bytes), ramp());
}

// CFITSIO 4.2 writes beyond its array of axes.
TEST(FitsImage, RefusesMoreAxesThanCfitsioHolds) {
  std::string bytes = encoded(ForeignImage{.shape = {columns, rows}, .values = ramp()});
  for (const char* count : {"100", "200", "999"}) {
    bytes.replace(bytes.find("NAXIS   =") + 27, 3, count);
    EXPECT_EQ(error_of(bytes), std::string("frame.fits: NAXIS: must be at most 99, got ") + count);
  }
}

TEST(FitsImage, HasNoValueWhereThereIsBlankOrNan) {
  auto values = ramp();
  values[3] = values[77] = NAN;
  for (const int bitpix : {SHORT_IMG, LONG_IMG, LONGLONG_IMG, FLOAT_IMG, DOUBLE_IMG}) {
    const auto back = read(encoded(ForeignImage{.bitpix = bitpix,
                                                .shape = {columns, rows},
                                                .values = values,
                                                .blank = bitpix > 0 ? -32000 : 0}));
    for (std::size_t i = 0; i < back.size(); ++i)
      EXPECT_EQ(std::isnan(back[i]), i == 3 || i == 77) << bitpix << " " << i;
  }
}

TEST(FitsImage, ReadsTilesOfRiceAndGzip) {
  for (const int compression : {RICE_1, GZIP_1, GZIP_2})
    for (const int bitpix : {BYTE_IMG, SHORT_IMG, USHORT_IMG, LONG_IMG})
      EXPECT_EQ(read(encoded(ForeignImage{.bitpix = bitpix,
                                          .shape = {columns, rows},
                                          .values = ramp(),
                                          .compression = compression})),
                ramp())
          << compression << " " << bitpix;
}

// CFITSIO quantises floats to a fraction of their noise, with dithering.
TEST(FitsImage, ReadsQuantisedFloats) {
  for (const int compression : {RICE_1, GZIP_1, GZIP_2}) {
    auto values = ramp(1, 1.37);
    values[5] = NAN;
    const auto back = read(encoded(ForeignImage{.bitpix = FLOAT_IMG,
                                                .shape = {columns, rows},
                                                .values = values,
                                                .compression = compression}));
    EXPECT_TRUE(std::isnan(back[5]));
    for (std::size_t i = 6; i < back.size(); ++i) EXPECT_NEAR(back[i], values[i], 30) << i;
  }
}

TEST(FitsImage, ReadsPlanesOfACube) {
  for (const int compression : {0, RICE_1}) {
    const auto all = ramp(4);
    const std::string bytes = encoded(ForeignImage{.bitpix = SHORT_IMG,
                                                   .shape = {columns, rows, 4},
                                                   .values = all,
                                                   .compression = compression});
    EXPECT_EQ(FitsImage(bytes, "x").planes(), 4);
    const auto third = read(bytes, 2);
    EXPECT_TRUE(std::equal(third.begin(), third.end(), all.begin() + 2 * columns * rows));
  }
  const std::string flat =
      encoded(ForeignImage{.bitpix = SHORT_IMG, .shape = {columns, rows, 1, 1}, .values = ramp()});
  EXPECT_EQ(FitsImage(flat, "x").planes(), 1);
}

TEST(FitsImage, CardsOfAnExtensionComeBeforeThoseOfThePrimaryHeader) {
  std::string bytes = encoded(ForeignImage{.shape = {columns, rows},
                                           .values = ramp(),
                                           .cards = {test::card("EXPTIME", "2.0")},
                                           .in_extension = true});
  std::string stated = test::card("EXPTIME", "7.0") + std::string(61, ' ');
  stated.resize(80, ' ');
  std::string gain = test::card("EGAIN", "0.5");
  gain.resize(80, ' ');
  bytes.replace(bytes.find("END      "), 240, stated + gain + "END" + std::string(77, ' '));
  const FitsImage image(bytes, "x");
  EXPECT_EQ(image.values().at("EXPTIME"), "2.0");
  EXPECT_EQ(image.values().at("EGAIN"), "0.5");
}

TEST(FitsImage, NamesHduKeywordAndReason) {
  const std::string good =
      encoded(ForeignImage{.bitpix = FLOAT_IMG, .shape = {columns, rows}, .values = ramp()});
  EXPECT_THAT(error_of(good.substr(0, 5760)), HasSubstr("frame.fits: is truncated: 5760 of "));
  EXPECT_EQ(error_of("SIMPLE"), "frame.fits: SIMPLE: not a FITS file");
  EXPECT_EQ(
      error_of(encoded(ForeignImage{.shape = {columns}, .values = ramp()}).substr(0, 2880 * 2)),
      "frame.fits: HDU 1: NAXIS: must be 2 or more, got 1");
  EXPECT_EQ(error_of(encoded(ForeignImage{.shape = {columns, rows, 2, 2}, .values = ramp(4)})),
            "frame.fits: HDU 1: NAXIS4: a fourth axis must be 1 long, got 2");
  EXPECT_EQ(error_of(encoded(ForeignImage{
                .shape = {columns, rows}, .values = ramp(), .compression = HCOMPRESS_1})),
            "frame.fits: HDU 2: ZCMPTYPE: must be RICE_1, GZIP_1 or GZIP_2, got HCOMPRESS_1");
}

// CFITSIO's decoder would read beyond the tile.
TEST(FitsImage, RefusesATileThatEndsTooEarly) {
  std::string bytes = encoded(ForeignImage{
      .bitpix = LONG_IMG, .shape = {columns, rows}, .values = ramp(), .compression = RICE_1});
  bytes.replace(bytes.find("ZTILE1  =") + 10, 20, "                   1");
  EXPECT_THAT(error_of(bytes), HasSubstr("frame.fits: HDU 2: NAXIS2: must be the number of tiles"));
  bytes = encoded(ForeignImage{
      .bitpix = LONG_IMG, .shape = {columns, rows}, .values = ramp(), .compression = RICE_1});
  // The descriptors of the first rows: of 8 bytes, length and offset.
  const std::size_t data = bytes.find("END  ", 2880 + 80);
  const std::size_t table = (data / 2880 + 1) * 2880;
  bytes[table + 2] = 0;
  bytes[table + 3] = 4;
  EXPECT_EQ(error_of(bytes), "frame.fits: HDU 2: tile 1 can't be unpacked");
  bytes[table] = 0x10;
  EXPECT_EQ(error_of(bytes), "frame.fits: HDU 2: tile 1 is not within the file");
}

}  // namespace
}  // namespace dmise
