#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/pictures/picture_codec.h"

// The picture module of the wheel: PNG by libpng alone, for OpenImageIO is 400 MB with what it
// needs.
namespace dmise {
namespace {

/// libpng's description of an image, freed.
struct PngImage {
  png_image image{};
  PngImage() { image.version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(&image); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
  [[noreturn]] void fail() const { throw Error(image.message); }
};

std::size_t big_endian(std::string_view four) {
  std::size_t value = 0;
  for (const char byte : four) value = value << 8 | static_cast<unsigned char>(byte);
  return value;
}

/// A PNG file whose samples libpng keeps as they are, because nothing in it tells their colours.
struct PlainPng {
  std::string bytes;
  bool srgb = true;  // what it told, by the rule of OpenImageIO

  explicit PlainPng(std::string_view file) : bytes(file.substr(0, 8)) {
    bool told_srgb = false, told_gamma = false;
    std::size_t at = bytes.size();
    while (at + 12 <= file.size()) {  // length, type, CRC
      const std::string_view type = file.substr(at + 4, 4);
      if (type == "IDAT") break;
      const std::string_view chunk = file.substr(at, 12 + big_endian(file.substr(at, 4)));
      told_srgb |= type == "sRGB";
      told_gamma |= type == "gAMA";
      const auto colours = {"sRGB", "gAMA", "cHRM", "iCCP", "cICP"};
      if (std::ranges::find(colours, type) == colours.end()) bytes += chunk;
      at += chunk.size();
    }
    bytes += file.substr(at);
    srgb = told_srgb || !told_gamma;
  }
};

double linear_of_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

void need_png(const std::string& format) {
  if (format != "png")
    throw Error("the Python package has PNG pictures alone; the package of Debian has the others");
}

class PngCodec final : public PictureCodec {
 public:
  std::string encode(const Picture& picture, const std::string& format) override {
    need_png(format);
    PngImage png;
    png.image.width = png_uint_32(picture.columns);
    png.image.height = png_uint_32(picture.rows);
    png.image.format = picture.channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png.image), '\0');
    png_alloc_size_t size = bytes.size();
    if (!png_image_write_to_memory(&png.image, bytes.data(), &size, 0, picture.pixels.data(), 0,
                                   nullptr))
      png.fail();
    bytes.resize(size);
    return bytes;
  }

  std::string encode_exr(const ExrImage&) override {
    need_png("openexr");
    return "";
  }

  LinearPicture decode(std::string_view bytes, const std::string& format, PictureOf what) override {
    need_png(format);
    const PlainPng plain(bytes);
    PngImage png;
    if (!png_image_begin_read_from_memory(&png.image, plain.bytes.data(), plain.bytes.size()))
      png.fail();
    const std::size_t pixels = std::size_t(png.image.width) * std::size_t(png.image.height);
    if (pixels > max_picture_pixels)
      throw Error("has " + std::to_string(png.image.width) + " x " +
                  std::to_string(png.image.height) + " pixels, more than " +
                  std::to_string(max_picture_pixels >> 20) + " Mi");
    const bool grey = !(png.image.format & PNG_FORMAT_FLAG_COLOR);
    const int channels = grey ? 1 : 3;
    LinearPicture picture{int(png.image.width), int(png.image.height), channels, {}};
    picture.pixels.resize(pixels * std::size_t(channels));
    // With alpha, which is taken out again: without it libpng would mix with a background.
    if (png.image.format & PNG_FORMAT_FLAG_LINEAR)  // 16 bits
      read<png_uint_16>(png, grey ? PNG_FORMAT_LINEAR_Y_ALPHA : PNG_FORMAT_LINEAR_RGB_ALPHA,
                        65535.0f, picture);
    else
      read<png_byte>(png, grey ? PNG_FORMAT_GA : PNG_FORMAT_RGBA, 255.0f, picture);
    if (what == PictureOf::light && plain.srgb)
      for (float& v : picture.pixels) v = float(linear_of_srgb(v));
    return picture;
  }

 private:
  template <class Sample>
  static void read(PngImage& png, png_uint_32 format, float most, LinearPicture& picture) {
    png.image.format = format;
    const auto stored = std::size_t(picture.channels) + 1;
    std::vector<Sample> samples(PNG_IMAGE_SIZE(png.image) / sizeof(Sample));
    if (!png_image_finish_read(&png.image, nullptr, samples.data(), 0, nullptr)) png.fail();
    const bool associated = format & PNG_FORMAT_FLAG_LINEAR;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
      const std::size_t first = i / (stored - 1) * stored, channel = i % (stored - 1);
      const auto alpha = float(samples[first + stored - 1]);
      const float whole = associated && alpha > 0.0f ? alpha : most;
      picture.pixels[i] = float(samples[first + channel]) / whole;
    }
  }
};

}  // namespace
}  // namespace dmise

// Entry of the shared object: a PictureCodec.
extern "C" void* dmise_make_picture_codec(std::string&) {
  return static_cast<dmise::PictureCodec*>(new dmise::PngCodec);
}
