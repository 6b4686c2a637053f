#include "core/pictures/picture_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <numeric>
#include <thread>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "tests/support/command.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

using test::command_output;
using testing::HasSubstr;

std::string scratch(const std::string& name) { return testing::TempDir() + "/pictures-" + name; }

ExpectedElectronImage sample_map(int columns = 200, int rows = 150) {
  ExpectedElectronImage image(columns, rows);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = 1000.0f + float(i % 977) / 7.0f;
  return image;
}

Picture sample_picture(int channels) {
  Picture picture{37, 21, channels, {}};
  for (int i = 0; i < 37 * 21 * channels; ++i) picture.pixels.push_back(std::uint8_t(i * 7));
  return picture;
}

double sum_of(const auto& pixels) { return std::accumulate(pixels.begin(), pixels.end(), 0.0); }

std::string number(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", v);
  return text;
}

double linear_of(int srgb) {
  const double v = srgb / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

std::string complaint(std::string_view bytes) {
  try {
    decode_picture(bytes);
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

bool is_loaded(const std::string& library) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (line.find(library) != line.npos) return true;
  return false;
}

TEST(Pictures, LoadNothingBeforeTheFirst) {
  if (!is_loaded("libdmise_pictures")) {  // the first test of this process
    EXPECT_FALSE(is_loaded("libOpenImageIO"));
    encode_picture(sample_picture(1), "png");
  }
  EXPECT_TRUE(is_loaded("libOpenImageIO"));
}

// Reference: the PNG specification (ISO/IEC 15948) in 60 lines of Python.
TEST(Png, EveryPixelIsWhatWasWritten) {
  for (const int channels : {1, 3}) {
    const Picture picture = sample_picture(channels);
    write_picture(scratch("sample.png"), picture);
    const auto [status, output] = command_output(
        "python3 " DMISE_SOURCE_DIR "/tests/reference/read_png.py " + scratch("sample.png"));
    EXPECT_EQ(status, 0) << output;
    std::string pixels;
    for (const auto v : picture.pixels) pixels += std::to_string(v) + " ";
    pixels.back() = '\n';
    EXPECT_EQ(output, "37 21 " + std::to_string(channels) + "\n" + pixels);
  }
}

TEST(Pictures, EveryFormatIsReadBack) {
  for (const int channels : {1, 3})
    for (const std::string format : {"png", "tiff", "jpeg"}) {
      const Picture picture = sample_picture(channels);
      const std::string bytes = encode_picture(picture, format);
      EXPECT_EQ(bytes, encode_picture(picture, format));
      const LinearPicture back = decode_picture(bytes);
      EXPECT_EQ(back.columns, 37);
      EXPECT_EQ(back.rows, 21);
      ASSERT_EQ(back.channels, channels);
      ASSERT_EQ(back.pixels.size(), picture.pixels.size());
      double worst = 0.0;
      for (std::size_t i = 0; i < back.pixels.size(); ++i)
        worst = std::max(worst, std::abs(back.pixels[i] - linear_of(picture.pixels[i])));
      if (format != "jpeg") {
        EXPECT_LT(worst, 1e-6) << format;
      }
    }
}

// A slope of grey is what JPEG keeps best.
TEST(Pictures, JpegKeepsASlope) {
  Picture picture{64, 64, 1, {}};
  for (int i = 0; i < 64 * 64; ++i) picture.pixels.push_back(std::uint8_t(20 + 3 * (i % 64)));
  const LinearPicture back = decode_picture(encode_picture(picture, "jpeg"));
  for (std::size_t i = 0; i < back.pixels.size(); ++i) {
    EXPECT_GT(back.pixels[i], linear_of(picture.pixels[i] - 3));
    EXPECT_LT(back.pixels[i], linear_of(picture.pixels[i] + 3));
  }
}

TEST(Pictures, WhatIsNoneIsOneLine) {
  EXPECT_EQ(complaint("v 1 2 3\n"), "is not a PNG, TIFF, JPEG or EXR file");
  EXPECT_EQ(complaint(""), "is not a PNG, TIFF, JPEG or EXR file");
  for (const std::string format : {"png", "tiff", "jpeg"}) {
    const std::string bytes = encode_picture(sample_picture(3), format);
    const std::string words = complaint(bytes.substr(0, 40));
    EXPECT_THAT(words, HasSubstr(format + " can't be read: "));
    EXPECT_EQ(words.find('\n'), std::string::npos);
  }
  EXPECT_THROW(read_picture("/dev/zero"), ConfigError);
  EXPECT_THROW(encode_picture(Picture{}, "png"), Error);
  EXPECT_THROW(write_picture(scratch("a.bmp"), sample_picture(1)), Error);
}

/// A number of a fixed sequence (the congruential generator of Numerical Recipes).
std::uint32_t next(std::uint32_t& state) { return state = state * 1664525u + 1013904223u; }

// Whatever the bytes, reading gives a picture of finite pixels or one line, and prints nothing.
TEST(Pictures, ChangedBytesAreAPictureOrOneLine) {
  const ExpectedElectronImage map = sample_map();
  std::vector<std::string> whole{
      encode_exr({.columns = 200, .rows = 20, .channels = {{"Y", map.pixels.data()}}})};
  for (const int channels : {1, 3})
    for (const std::string format : {"png", "tiff", "jpeg"})
      whole.push_back(encode_picture(sample_picture(channels), format));
  testing::internal::CaptureStderr();
  std::uint32_t state = 1;
  int read = 0, refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string bytes = whole[std::size_t(i) % whole.size()];
    // One to eight bytes anywhere, half of the time in the headers; now and then the end is lost.
    const std::size_t reach =
        next(state) >> 31 ? bytes.size() : std::min<std::size_t>(bytes.size(), 200);
    for (std::uint32_t k = next(state) >> 29; k < 8; ++k)
      bytes[next(state) % reach] = char(next(state) >> 24);
    if (next(state) >> 29 == 0) bytes.resize(next(state) % bytes.size());
    try {
      const LinearPicture picture = decode_picture(bytes);
      ASSERT_EQ(picture.pixels.size(), std::size_t(picture.columns) * std::size_t(picture.rows) *
                                           std::size_t(picture.channels));
      for (const float v : picture.pixels) ASSERT_TRUE(std::isfinite(v));
      ++read;
    } catch (const ConfigError& error) {
      ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      ++refused;
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 100);
}

// Several threads of a process read at once: nothing is shared but the libraries.
TEST(Pictures, ThreadsReadAtOnce) {
  const std::string good = encode_picture(sample_picture(3), "png");
  std::string broken = good;
  broken[broken.size() / 2] ^= 0x55;
  testing::internal::CaptureStderr();
  std::vector<std::thread> threads;
  std::atomic<int> right = 0;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 100; ++i) {
        right += decode_picture(good).pixels.size() == 37u * 21u * 3u;
        try {
          decode_picture(broken);
        } catch (const ConfigError&) {
          ++right;
        }
      }
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(right, 800);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// A header that promises 60,000 x 60,000 pixels: refused before they are looked for.
TEST(Pictures, OnesTooLargeAreRefused) {
  std::string bytes = encode_picture(sample_picture(1), "png");
  // IHDR: width and height, big endian, at 16; its CRC at 29.
  std::memcpy(bytes.data() + 16, "\0\0\xea\x60\0\0\xea\x60", 8);
  std::uint32_t crc = ~0u;
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= std::uint8_t(bytes[i]);
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ (crc & 1 ? 0xEDB88320u : 0u);
  }
  crc = ~crc;
  for (int k = 0; k < 4; ++k) bytes[29 + std::size_t(k)] = char(crc >> (24 - 8 * k));
  EXPECT_EQ(complaint(bytes), "png can't be read: has 60000 x 60000 pixels, more than 16 Mi");
}

// Reference: the OpenEXR library's own Python module. Odd sizes; a block that can't be compressed.
TEST(Exr, OpenExrReadsEveryPixel) {
  const std::string python = test::python_with("OpenEXR");
  if (python.empty()) DMISE_SKIP() << "needs OpenEXR from PyPI: ./dmise setup --tests";
  for (const auto& [columns, rows] : {std::pair{1, 1}, {3, 17}, {701, 503}, {64, 16}}) {
    ExpectedElectronImage image(columns, rows);
    std::uint32_t state = 1;
    for (float& v : image.pixels) {
      state = state * 1664525u + 1013904223u;
      v = columns == 64 ? float(state) * 1e-3f : 300.0f + float(state >> 28);
    }
    image.pixels.front() = 1e12f;
    write_exr(scratch("map.exr"), {.columns = columns,
                                   .rows = rows,
                                   .channels = {{"Y", image.pixels.data()}},
                                   .attributes = {{"unit", "photon"}, {"frame", 7.0}}});
    const auto [status, output] = command_output(
        python + " " DMISE_SOURCE_DIR "/tests/reference/read_exr.py " + scratch("map.exr"));
    EXPECT_EQ(status, 0) << output;
    char corners[160];
    std::snprintf(corners, sizeof corners,
                  "channel Y shape %d %d float32 corners %.9g %.9g %.9g %.9g\n", rows, columns,
                  image.at(0, 0), image.at(columns - 1, 0), image.at(0, rows - 1),
                  image.at(columns - 1, rows - 1));
    EXPECT_EQ(output, corners + ("sum " + number(sum_of(image.pixels))) +
                          " unit photon frame 7 Compression.ZIP_COMPRESSION\n");
  }
}

TEST(Exr, OpenExrReadsEveryChannel) {
  const std::string python = test::python_with("OpenEXR");
  if (python.empty()) DMISE_SKIP() << "needs OpenEXR from PyPI: ./dmise setup --tests";
  constexpr int columns = 71, rows = 53;
  std::vector<ExpectedElectronImage> images(3, ExpectedElectronImage(columns, rows));
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < images[k].pixels.size(); ++i)
      images[k].pixels[i] = float(k + 1) * 1000.0f + float(i % 97);
  write_exr(scratch("bands.exr"), {.columns = columns,
                                   .rows = rows,
                                   .channels = {{"Y", images[1].pixels.data()},
                                                {"Z", images[2].pixels.data()},
                                                {"00500.00nm", images[0].pixels.data()}},
                                   .attributes = {{"unit", "photon"}, {"frame", 7.0}}});
  const auto [status, output] = command_output(
      python + " " DMISE_SOURCE_DIR "/tests/reference/read_exr.py " + scratch("bands.exr"));
  std::string expected;
  const char* names[] = {"00500.00nm", "Y", "Z"};
  for (std::size_t k = 0; k < 3; ++k) {
    const ExpectedElectronImage& image = images[k];
    char line[160];
    std::snprintf(line, sizeof line,
                  "channel %s shape %d %d float32 corners %.9g %.9g %.9g %.9g\nsum ", names[k],
                  rows, columns, image.at(0, 0), image.at(columns - 1, 0), image.at(0, rows - 1),
                  image.at(columns - 1, rows - 1));
    expected +=
        line + number(sum_of(image.pixels)) + " unit photon frame 7 Compression.ZIP_COMPRESSION\n";
  }
  EXPECT_EQ(status, 0) << output;
  EXPECT_EQ(output, expected);
  EXPECT_THROW(
      encode_exr({.columns = columns,
                  .rows = rows,
                  .channels = {{"Y", images[0].pixels.data()}, {"Y", images[1].pixels.data()}}}),
      Error);
}

TEST(Exr, EqualImagesAreEqualBytesAndSmoothOnesAreSmaller) {
  const ExpectedElectronImage image = sample_map();
  const ExrImage exr{.columns = 200, .rows = 150, .channels = {{"Y", image.pixels.data()}}};
  EXPECT_EQ(encode_exr(exr), encode_exr(exr));
  EXPECT_LT(encode_exr(exr).size(), 200 * 150 * 4 * 0.7);
}

// What writes the time of day into the attribute capDate makes other bytes a second later.
TEST(Exr, HoldsTheTimeOfTheExposureAndNotOfItsWriting) {
  const ExpectedElectronImage image = sample_map();
  ExrImage exr{.columns = 200, .rows = 150, .channels = {{"Y", image.pixels.data()}}};
  const auto date_of = [](const std::string& bytes) {
    const std::string name("capDate\0string\0", 15);
    const std::size_t at = bytes.find(name);
    return at == std::string::npos ? std::string() : bytes.substr(at + name.size() + 4, 19);
  };
  EXPECT_EQ(date_of(encode_exr(exr)), "    :  :     :  :  ");
  exr.taken_utc = "2018:01:21 00:15:00";
  EXPECT_EQ(date_of(encode_exr(exr)), exr.taken_utc);
}

TEST(Exr, RefusesWhatNoFileHolds) {
  const ExpectedElectronImage image = sample_map();
  EXPECT_THROW(encode_exr({.columns = 2, .rows = 2}), Error);
  EXPECT_THROW(encode_exr({.columns = 0, .rows = 2, .channels = {{"Y", image.pixels.data()}}}),
               Error);
  EXPECT_THROW(encode_exr({.columns = 2,
                           .rows = 2,
                           .channels = {{"Y", image.pixels.data()}},
                           .attributes = {{std::string(32, 'x'), 1.0}}}),
               Error);
}

TEST(Exr, NoNanLeaves) {
  ExpectedElectronImage image = sample_map();
  image.at(0, 1) = std::numeric_limits<float>::infinity();
  EXPECT_THROW(encode_exr({.columns = 200, .rows = 150, .channels = {{"Y", image.pixels.data()}}}),
               Error);
}

}  // namespace
}  // namespace dmise
