#pragma once
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/image.h"

// Reads and writes picture files with OpenImageIO, in a module that is loaded at first use. Equal
// pictures give equal bytes with one version of the libraries. Files are written atomically; an
// `Error` names the file.
namespace dmise {

/// Writes PNG, TIFF or JPEG by the extension of `path`; grey or RGB by the picture's channels (1 or
/// 3).
void write_picture(const std::string& path, const Picture& picture);
/// A picture's file in memory. `format`: "png", "tiff" or "jpeg".
std::string encode_picture(const Picture& picture, const std::string& format);

/// A metadata item of an EXR file.
struct ExrAttribute {
  std::string name;  // at most 31 characters
  std::variant<std::string, double> value;
};

struct ExrChannel {
  std::string name;               // at most 31 characters
  const float* pixels = nullptr;  // rows x columns, first row first
};

/// An EXR image of one or more channels of 32-bit floats.
struct ExrImage {
  int columns = 0, rows = 0;
  std::vector<ExrChannel> channels;  // with different names; viewers show Y as grey
  std::vector<ExrAttribute> attributes;
  // "YYYY:MM:DD hh:mm:ss", the Exif format; blanks if unknown.
  std::string taken_utc = "    :  :     :  :  ";
};

/// Encodes OpenEXR in scan lines with lossless ZIP compression. Throws `Error` for invalid channel
/// names, duplicate channels, no pixels or values that are not finite.
std::string encode_exr(ExrImage image);
void write_exr(const std::string& path, const ExrImage& image);

/// Meaning of the samples: light is converted to linear if the file is sRGB; another quantity is
/// kept unchanged.
enum class PictureOf { light, quantity };

struct LinearPicture {
  int columns = 0, rows = 0, channels = 1;  // 1: grey, 3: red, green, blue
  std::vector<float> pixels;                // rows x columns x channels, first row first
};

/// Limits of a picture that is read: pixels, and bytes of its file.
inline constexpr std::size_t max_picture_pixels = std::size_t(1) << 24;
inline constexpr std::size_t max_picture_bytes = std::size_t(1) << 28;

/// Reads a regular file in PNG, TIFF, JPEG or EXR, recognised by its first bytes. Alpha is dropped.
/// Throws `ConfigError` "PATH: reason".
LinearPicture read_picture(const std::string& path, PictureOf what = PictureOf::light);
LinearPicture decode_picture(std::string_view bytes, PictureOf what = PictureOf::light);

}  // namespace dmise
