#pragma once
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/image.h"

// Files of pictures, by OpenImageIO in a module that is loaded when the first is written or read.
// Equal pictures give equal bytes with one version of the libraries. Files are written whole or not
// at all; an `Error` names the file.
namespace dmise {

/// Writes PNG, TIFF or JPEG by the ending of `path`; grey or RGB by the picture's channels (1, 3).
void write_picture(const std::string& path, const Picture& picture);
/// The same in memory. `format`: "png", "tiff" or "jpeg".
std::string encode_picture(const Picture& picture, const std::string& format);

/// What an EXR file says beside its pixels; viewers show it.
struct ExrAttribute {
  std::string name;  // at most 31 characters
  std::variant<std::string, double> value;
};

struct ExrChannel {
  std::string name;               // at most 31 characters
  const float* pixels = nullptr;  // rows x columns, first row first
};

/// An image of channels of 32-bit floats, one as a rule.
struct ExrImage {
  std::string channel = "Y";      // at most 31 characters; Y is what viewers show as grey
  const float* pixels = nullptr;  // rows x columns, first row first
  int columns = 0, rows = 0;
  std::vector<ExrAttribute> attributes;
  // "YYYY:MM:DD hh:mm:ss", as Exif has it; blanks where a time is not known.
  std::string taken_utc = "    :  :     :  :  ";
  std::vector<ExrChannel> more;  // beside `channel`, of other names
};

/// OpenEXR in scan lines with ZIP compression, without loss. Throws `Error` for an image or a name
/// that can't be.
std::string encode_exr(const ExrImage& image);
void write_exr(const std::string& path, const ExrImage& image);

/// What the numbers of a file stand for: light, which is made linear where the file holds sRGB, or
/// another quantity, which is kept as it is.
enum class PictureOf { light, quantity };

struct LinearPicture {
  int columns = 0, rows = 0, channels = 1;  // 1: grey, 3: red, green, blue
  std::vector<float> pixels;                // rows x columns x channels, first row first
};

/// Most pixels of a picture that is read, and most bytes of its file.
inline constexpr std::size_t most_picture_pixels = std::size_t(1) << 24;
inline constexpr std::size_t most_picture_bytes = std::size_t(1) << 28;

/// Reads a regular file of PNG, TIFF, JPEG or EXR, told by its first bytes. Alpha is left out.
/// Throws `ConfigError` "PATH: reason".
LinearPicture read_picture(const std::string& path, PictureOf what = PictureOf::light);
LinearPicture decode_picture(std::string_view bytes, PictureOf what = PictureOf::light);

}  // namespace dmise
