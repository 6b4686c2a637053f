#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <memory>

#include "core/base/error.h"
#include "core/base/module.h"
#include "core/pictures/picture_codec.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

/// The picture module of the wheel; null where it was not built.
std::unique_ptr<PictureCodec> codec_of_wheel() {
#ifdef DMISE_PNG_MODULE
  setenv("DMISE_TEST_PNG_MODULE", DMISE_PNG_MODULE, 1);
  return std::unique_ptr<PictureCodec>(static_cast<PictureCodec*>(
      made_by_module({"pictures", "DMISE_TEST_PNG_MODULE"}, "dmise_make_picture_codec")));
#else
  return nullptr;
#endif
}

std::string four_bytes(unsigned long v) {
  return {char(v >> 24 & 255), char(v >> 16 & 255), char(v >> 8 & 255), char(v & 255)};
}

std::string chunk_of(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  return four_bytes(data.size()) + body +
         four_bytes(crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size())));
}

constexpr int png_columns = 32, png_rows = 8;

/// A PNG file by its specification (ISO/IEC 15948); `chunks` are before the samples.
std::string png_of(int bits, int colour_type, int channels, const std::string& chunks) {
  std::string rows;
  unsigned state = 1;
  for (int row = 0; row < png_rows; ++row) {
    rows += '\0';  // no filter
    for (int i = 0; i < png_columns * channels * bits / 8; ++i) {
      state = state * 1664525u + 1013904223u;
      rows += char(0x80u | state >> 24);  // so that no alpha is small
    }
  }
  std::string packed(compressBound(rows.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(rows.data()), rows.size());
  packed.resize(size);
  const std::string header = four_bytes(png_columns) + four_bytes(png_rows) + char(bits) +
                             char(colour_type) + std::string(3, '\0');
  return "\x89PNG\r\n\x1a\n" + chunk_of("IHDR", header) + chunks + chunk_of("IDAT", packed) +
         chunk_of("IEND", "");
}

std::string palette() {
  std::string colours;
  for (int i = 0; i < 256 * 3; ++i) colours += char(i * 37);
  return chunk_of("PLTE", colours);
}

// Reference: OpenImageIO. What is of 16 bits keeps them, and what a file tells of its colours
// counts for light alone.
TEST(PngCodec, ReadsWhatOpenImageIoReads) {
  const auto codec = codec_of_wheel();
  if (!codec) DMISE_SKIP() << "needs libpng-dev: ./dmise setup --tests";
  const std::string srgb = chunk_of("sRGB", std::string(1, '\0'));
  const std::string gamma = chunk_of("gAMA", four_bytes(45455));
  const std::string linear = chunk_of("gAMA", four_bytes(100000));
  const struct {
    int bits, colour_type, channels;
    double most;
  } kinds[] = {{8, 0, 1, 1e-6}, {16, 0, 1, 1e-6}, {8, 2, 3, 1e-6}, {16, 2, 3, 1e-6},
               {8, 4, 2, 1e-6}, {8, 6, 4, 1e-6},  {8, 3, 1, 1e-6}, {16, 6, 4, 1e-4}};
  for (const auto& kind : kinds)
    for (const std::string& told : {std::string(), srgb, gamma, linear, srgb + gamma})
      for (const PictureOf what : {PictureOf::light, PictureOf::quantity}) {
        const std::string bytes = png_of(kind.bits, kind.colour_type, kind.channels,
                                         told + (kind.colour_type == 3 ? palette() : ""));
        const LinearPicture ours = codec->decode(bytes, "png", what),
                            theirs = decode_picture(bytes, what);
        ASSERT_EQ(ours.columns, png_columns);
        ASSERT_EQ(ours.rows, png_rows);
        ASSERT_EQ(ours.channels, theirs.channels);
        ASSERT_EQ(ours.pixels.size(), theirs.pixels.size());
        double worst = 0.0;
        for (std::size_t i = 0; i < ours.pixels.size(); ++i)
          worst = std::max(worst, double(std::abs(ours.pixels[i] - theirs.pixels[i])));
        EXPECT_LT(worst, kind.most)
            << kind.bits << " bits, colour type " << kind.colour_type << ", " << told.size()
            << " bytes of colours, light " << (what == PictureOf::light);
      }
}

TEST(PngCodec, WritesWhatOpenImageIoReads) {
  const auto codec = codec_of_wheel();
  if (!codec) DMISE_SKIP() << "needs libpng-dev: ./dmise setup --tests";
  for (const int channels : {1, 3}) {
    Picture picture{37, 21, channels, {}};
    for (int i = 0; i < 37 * 21 * channels; ++i) picture.pixels.push_back(std::uint8_t(i * 7));
    const auto bytes = codec->encode(picture, "png");
    const LinearPicture back = decode_picture(bytes, PictureOf::quantity);
    ASSERT_EQ(back.channels, channels);
    ASSERT_EQ(back.pixels.size(), picture.pixels.size());
    for (std::size_t i = 0; i < back.pixels.size(); ++i)
      EXPECT_EQ(std::lround(255 * back.pixels[i]), picture.pixels[i]);
    EXPECT_THROW(codec->encode(picture, "jpeg"), Error);
  }
}

TEST(PngCodec, ChangedBytesAreAPictureOrOneLine) {
  const auto codec = codec_of_wheel();
  if (!codec) DMISE_SKIP() << "needs libpng-dev: ./dmise setup --tests";
  testing::internal::CaptureStderr();
  unsigned state = 1;
  const auto next = [&] { return (state = state * 1664525u + 1013904223u) >> 8; };
  int read = 0, refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string bytes =
        png_of(i % 2 ? 8 : 16, i % 3 ? 2 : 6, i % 3 ? 3 : 4, chunk_of("gAMA", four_bytes(45455)));
    const std::size_t reach = i % 4 ? 80 : bytes.size();
    if (i % 5) bytes[8 + next() % (reach - 8)] = char(next());
    if (i % 7 == 0) bytes.resize(8 + next() % (bytes.size() - 8));
    try {
      const LinearPicture picture = codec->decode(bytes, "png", PictureOf::light);
      ASSERT_EQ(picture.pixels.size(), std::size_t(picture.columns) * std::size_t(picture.rows) *
                                           std::size_t(picture.channels));
      for (const float v : picture.pixels) ASSERT_TRUE(std::isfinite(v));
      ++read;
    } catch (const Error& error) {
      ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      ++refused;
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace dmise
