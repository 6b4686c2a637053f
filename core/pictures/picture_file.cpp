#include "core/pictures/picture_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/base/module.h"
#include "core/base/printable.h"
#include "core/pictures/picture_codec.h"

namespace dmise {
namespace {

constexpr std::size_t longest_name = 31;

PictureCodec& codec() {
  static const std::unique_ptr<PictureCodec> loaded(static_cast<PictureCodec*>(
      made_by_module({"pictures", "DMISE_PICTURES_MODULE"}, "dmise_make_picture_codec")));
  return *loaded;
}

std::string format_by_ending(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".png") return "png";
  if (ending == ".tif" || ending == ".tiff") return "tiff";
  if (ending == ".jpg" || ending == ".jpeg") return "jpeg";
  throw Error("must end in .png, .tif, .tiff, .jpg or .jpeg");
}

std::string format_of(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) return "png";
  if (bytes.starts_with("\xff\xd8\xff"sv)) return "jpeg";
  if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv)) return "tiff";
  if (bytes.starts_with("\x76\x2f\x31\x01"sv)) return "openexr";
  throw ConfigError("is not a PNG, TIFF, JPEG or EXR file");
}

void check_name(const std::string& name) {
  if (name.empty() || name.size() > longest_name || name.find('\0') != std::string::npos)
    throw Error("EXR can't be written: a name must have 1..31 characters, got " + name);
}

/// Returns `work()`; errors get the file's name.
template <class Work>
auto of_file(const std::string& path, Work&& work) {
  try {
    return work();
  } catch (const ConfigError& error) {
    throw ConfigError(printable(path) + ": " + error.what());
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
}

}  // namespace

std::string encode_picture(const Picture& picture, const std::string& format) {
  if (picture.columns < 1 || picture.rows < 1 || (picture.channels != 1 && picture.channels != 3))
    throw Error("picture can't be written: it needs pixels of 1 or 3 channels");
  return codec().encode(picture, format);
}

void write_picture(const std::string& path, const Picture& picture) {
  write_file_whole(path,
                   of_file(path, [&] { return encode_picture(picture, format_by_ending(path)); }));
}

std::string encode_exr(ExrImage image) {
  for (const auto& attribute : image.attributes) check_name(attribute.name);
  std::vector<ExrChannel>& channels = image.channels;
  std::ranges::sort(channels, {}, &ExrChannel::name);  // the order in files
  for (std::size_t i = 1; i < channels.size(); ++i)
    if (channels[i].name == channels[i - 1].name)
      throw Error("EXR can't be written: two channels " + channels[i].name);
  if (image.columns < 1 || image.rows < 1 || channels.empty())
    throw Error("EXR can't be written: no pixels");
  const std::size_t count = std::size_t(image.columns) * std::size_t(image.rows);
  for (const ExrChannel& channel : channels) {
    check_name(channel.name);
    if (!channel.pixels) throw Error("EXR can't be written: no pixels");
    for (std::size_t i = 0; i < count; ++i)
      if (!std::isfinite(channel.pixels[i]))
        throw Error("EXR can't be written: not a finite number at pixel " + std::to_string(i));
  }
  return codec().encode_exr(image);
}

void write_exr(const std::string& path, const ExrImage& image) {
  write_file_whole(path, of_file(path, [&] { return encode_exr(image); }));
}

LinearPicture decode_picture(std::string_view bytes, PictureOf what) {
  if (bytes.size() > max_picture_bytes)
    throw ConfigError("is larger than " + std::to_string(max_picture_bytes >> 20) + " MiB");
  const std::string format = format_of(bytes);
  try {
    return codec().decode(bytes, format, what);
  } catch (const Error& error) {
    throw ConfigError(format + " can't be read: " + printable(error.what()));
  }
}

LinearPicture read_picture(const std::string& path, PictureOf what) {
  const std::string bytes = read_text_file(path, max_picture_bytes);
  return of_file(path, [&] { return decode_picture(bytes, what); });
}

}  // namespace dmise
