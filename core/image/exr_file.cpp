#include "core/image/exr_file.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/base/error.h"
#include "core/base/whole_file.h"

namespace dmise {
namespace {

constexpr int rows_in_block = 16;   // of ZIP compression
constexpr int zip_compression = 3;  // its number in the file
constexpr int float_pixels = 2;
constexpr int zlib_level = 1;  // 3 % larger files than at 4 in a third of the time
constexpr std::size_t longest_name = 31;

static_assert(std::endian::native == std::endian::little);  // as the file's numbers are

template <class T>
void put(std::string& bytes, T number) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof raw);
}

void put_name(std::string& bytes, const std::string& name) {
  if (name.empty() || name.size() > longest_name || name.find('\0') != std::string::npos)
    throw Error("EXR can't be written: a name must have 1..31 characters, got " + name);
  bytes += name;
  bytes += '\0';
}

void put_attribute(std::string& bytes, const std::string& name, const char* type,
                   const std::string& value) {
  put_name(bytes, name);
  put_name(bytes, type);
  put(bytes, std::int32_t(value.size()));
  bytes += value;
}

template <class... T>
std::string packed(T... numbers) {
  std::string bytes;
  (put(bytes, numbers), ...);
  return bytes;
}

/// In the order in which the file has them: by name.
std::vector<ExrChannel> channels_of(const ExrImage& image) {
  std::vector<ExrChannel> channels{{image.channel, image.pixels}};
  channels.insert(channels.end(), image.more.begin(), image.more.end());
  std::sort(channels.begin(), channels.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  for (std::size_t i = 1; i < channels.size(); ++i)
    if (channels[i].name == channels[i - 1].name)
      throw Error("EXR can't be written: two channels " + channels[i].name);
  return channels;
}

std::string header_of(const ExrImage& image, const std::vector<ExrChannel>& of_file) {
  std::string bytes = packed(std::uint32_t{20000630}, std::uint32_t{2});
  std::string channels;
  for (const ExrChannel& channel : of_file) {
    put_name(channels, channel.name);
    channels +=
        packed(std::int32_t{float_pixels}, std::uint32_t{0}, std::int32_t{1}, std::int32_t{1});
  }
  channels += '\0';
  const std::string window = packed(std::int32_t{0}, std::int32_t{0},
                                    std::int32_t{image.columns - 1}, std::int32_t{image.rows - 1});
  put_attribute(bytes, "channels", "chlist", channels);
  put_attribute(bytes, "compression", "compression", packed(std::uint8_t{zip_compression}));
  put_attribute(bytes, "dataWindow", "box2i", window);
  put_attribute(bytes, "displayWindow", "box2i", window);
  put_attribute(bytes, "lineOrder", "lineOrder", packed(std::uint8_t{0}));
  put_attribute(bytes, "pixelAspectRatio", "float", packed(1.0f));
  put_attribute(bytes, "screenWindowCenter", "v2f", packed(0.0f, 0.0f));
  put_attribute(bytes, "screenWindowWidth", "float", packed(1.0f));
  for (const auto& [name, value] : image.attributes) {
    if (const auto* text = std::get_if<std::string>(&value))
      put_attribute(bytes, name, "string", *text);
    else
      put_attribute(bytes, name, "double", packed(std::get<double>(value)));
  }
  bytes += '\0';
  return bytes;
}

// Bytes apart by their place in a number, then differences, then deflated; as they are where that
// is no gain.
std::string zipped(const char* raw, std::size_t size) {
  std::string apart(size, '\0');
  const std::size_t half = (size + 1) / 2;
  for (std::size_t i = 0; i < size; ++i) apart[i / 2 + (i % 2 ? half : 0)] = raw[i];
  for (std::size_t i = size - 1; i > 0; --i)
    apart[i] = char(std::uint8_t(std::uint8_t(apart[i]) - std::uint8_t(apart[i - 1]) + 128));
  uLongf room = compressBound(uLong(size));
  std::string deflated(room, '\0');
  const int code = compress2(reinterpret_cast<Bytef*>(deflated.data()), &room,
                             reinterpret_cast<const Bytef*>(apart.data()), uLong(size), zlib_level);
  if (code != Z_OK) throw Error("EXR can't be written: zlib refused it");
  deflated.resize(room);
  return room < size ? deflated : std::string(raw, size);
}

}  // namespace

std::string encode_exr(const ExrImage& image) {
  const std::vector<ExrChannel> channels = channels_of(image);
  const std::size_t count = std::size_t(image.columns) * std::size_t(image.rows);
  for (const ExrChannel& channel : channels) {
    if (image.columns < 1 || image.rows < 1 || !channel.pixels)
      throw Error("EXR can't be written: no pixels");
    for (std::size_t i = 0; i < count; ++i)
      if (!std::isfinite(channel.pixels[i]))
        throw Error("EXR can't be written: not a finite number at pixel " + std::to_string(i));
  }
  std::string bytes = header_of(image, channels);
  const int blocks = (image.rows + rows_in_block - 1) / rows_in_block;
  const std::size_t table = bytes.size();
  bytes.resize(table + std::size_t(blocks) * sizeof(std::uint64_t));
  for (int b = 0; b < blocks; ++b) {
    const int row = b * rows_in_block, count = std::min(rows_in_block, image.rows - row);
    std::vector<float> raw;  // row by row, in each channel by channel
    for (int y = row; y < row + count; ++y)
      for (const ExrChannel& channel : channels) {
        const float* from = channel.pixels + std::size_t(y) * std::size_t(image.columns);
        raw.insert(raw.end(), from, from + image.columns);
      }
    const std::string block =
        zipped(reinterpret_cast<const char*>(raw.data()), raw.size() * sizeof(float));
    const std::uint64_t at = bytes.size();
    std::memcpy(bytes.data() + table + std::size_t(b) * sizeof at, &at, sizeof at);
    bytes += packed(std::int32_t{row}, std::int32_t(block.size()));
    bytes += block;
  }
  return bytes;
}

void write_exr(const std::string& path, const ExrImage& image) {
  std::string bytes;
  try {
    bytes = encode_exr(image);
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
  write_file_whole(path, bytes);
}

}  // namespace dmise
