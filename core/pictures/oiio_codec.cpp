#include <OpenImageIO/imageio.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "core/base/error.h"
#include "core/pictures/picture_codec.h"

// The picture module: the only code that links OpenImageIO.
namespace dmise {
namespace {

constexpr int rows_at_once = 16;  // a block of ZIP compression

/// First line of a message of the library.
std::string first_line(std::string words) {
  words.resize(std::min(words.find('\n'), words.size()));
  return words.empty() ? "no reason given" : words;
}

/// A file in memory with a path that OpenImageIO can open: not every format of it reads from
/// memory.
class MemoryFile {
 public:
  MemoryFile() : file_(::memfd_create("picture", MFD_CLOEXEC)) {
    if (file_ < 0) throw Error(std::string("no memory for a picture: ") + std::strerror(errno));
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(file_); }

  std::string name() const { return "/proc/self/fd/" + std::to_string(file_); }
  void put(std::string_view bytes) {
    if (::pwrite(file_, bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
      throw Error(std::string("no memory for a picture: ") + std::strerror(errno));
  }
  std::string content() const {
    std::string bytes(std::size_t(std::max<off_t>(0, ::lseek(file_, 0, SEEK_END))), '\0');
    if (::pread(file_, bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
      throw Error(std::string("picture cannot be read back: ") + std::strerror(errno));
    return bytes;
  }

 private:
  int file_;
};

/// An image file being written.
class Output {
 public:
  Output(const std::string& format, const OIIO::ImageSpec& spec)
      : format_(format), out_(OIIO::ImageOutput::create(format)) {
    if (!out_) throw Error(format + " can't be written: " + first_line(OIIO::geterror()));
    if (!out_->open(memory_.name(), spec)) fail();
  }

  template <class T>
  void put_rows(int first, int end, const T* pixels) {
    if (!out_->write_scanlines(first, end, 0, OIIO::BaseTypeFromC<T>::value, pixels)) fail();
  }

  std::string finish() {
    if (!out_->close()) fail();
    return memory_.content();
  }

 private:
  [[noreturn]] void fail() {
    throw Error(format_ + " can't be written: " + first_line(out_->geterror()));
  }

  std::string format_;
  MemoryFile memory_;
  std::unique_ptr<OIIO::ImageOutput> out_;
};

double linear_of_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

class OiioCodec final : public PictureCodec {
 public:
  OiioCodec() {
    // The bytes must not depend on the number of threads, and a node has threads of its own.
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);
  }

  std::string encode(const Picture& picture, const std::string& format) override {
    OIIO::ImageSpec spec(picture.columns, picture.rows, picture.channels, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("png:compressionLevel", 4);
    spec.attribute("png:filter", 16);  // differences along rows
    spec.attribute("Compression", format == "jpeg" ? "jpeg:95" : "zip");
    Output out(format, spec);
    out.put_rows(0, picture.rows, picture.pixels.data());
    return out.finish();
  }

  std::string encode_exr(const ExrImage& image) override {
    const std::vector<ExrChannel>& channels = image.channels;
    const int count = int(channels.size());
    OIIO::ImageSpec spec(image.columns, image.rows, count, OIIO::TypeDesc::FLOAT);
    spec.channelnames.clear();
    for (const auto& channel : channels) spec.channelnames.push_back(channel.name);
    // Level 1: 3 % larger files than at 4 in a third of the time.
    spec.attribute("compression", "zip:1");
    // Without this, OpenImageIO writes the time of day.
    spec.attribute("DateTime", image.taken_utc);
    for (const auto& [name, value] : image.attributes) {
      if (const auto* text = std::get_if<std::string>(&value))
        spec.attribute(name, *text);
      else
        spec.attribute(name, OIIO::TypeDesc::DOUBLE, &std::get<double>(value));
    }
    Output out("openexr", spec);
    std::vector<float> rows;
    for (int first = 0; first < image.rows; first += rows_at_once) {
      const int end = std::min(first + rows_at_once, image.rows);
      const std::size_t from = std::size_t(first) * std::size_t(image.columns);
      const std::size_t pixels = std::size_t(end - first) * std::size_t(image.columns);
      rows.resize(pixels * channels.size());
      for (std::size_t c = 0; c < channels.size(); ++c)
        for (std::size_t i = 0; i < pixels; ++i)
          rows[i * channels.size() + c] = channels[c].pixels[from + i];
      out.put_rows(first, end, rows.data());
    }
    return out.finish();
  }

  LinearPicture decode(std::string_view bytes, const std::string& format, PictureOf what) override {
    MemoryFile memory;
    memory.put(bytes);
    const auto in = OIIO::ImageInput::create(format);
    if (!in) throw Error(first_line(OIIO::geterror()));
    const auto fail = [&] { throw Error(first_line(in->geterror())); };
    OIIO::ImageSpec spec, wanted;
    wanted.attribute("oiio:UnassociatedAlpha", 1);
    if (!in->open(memory.name(), spec, wanted)) fail();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
      throw Error("contains no image");
    const std::size_t pixels = std::size_t(spec.width) * std::size_t(spec.height);
    if (pixels > max_picture_pixels)
      throw Error("has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                  " pixels, more than " + std::to_string(max_picture_pixels >> 20) + " Mi");
    LinearPicture picture{spec.width, spec.height, spec.nchannels < 3 ? 1 : 3, {}};
    picture.pixels.resize(pixels * std::size_t(picture.channels));
    if (!in->read_image(0, 0, 0, picture.channels, OIIO::TypeDesc::FLOAT, picture.pixels.data()))
      fail();
    const bool srgb =
        what == PictureOf::light && spec.get_string_attribute("oiio:ColorSpace") == "sRGB";
    for (float& v : picture.pixels) {
      if (!std::isfinite(v)) throw Error("contains a value that is not finite");
      if (srgb) v = float(linear_of_srgb(v));
    }
    return picture;
  }
};

}  // namespace
}  // namespace dmise

// Entry of the shared object: a PictureCodec. Null with the reason when OpenImageIO does not start.
extern "C" void* dmise_make_picture_codec(std::string& reason) {
  try {
    return static_cast<dmise::PictureCodec*>(new dmise::OiioCodec);
  } catch (const std::exception& error) {
    reason = error.what();
    return nullptr;
  }
}
