#include "core/image/png_file.h"

#include <png.h>

#include <csetjmp>

#include "core/base/error.h"
#include "core/base/whole_file.h"

namespace dmise {
namespace {

void append(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}
void ignore_flush(png_structp) {}
void ignore_warning(png_structp, png_const_charp) {}
void jump_on_error(png_structp png, png_const_charp) { png_longjmp(png, 1); }

/// Plain data only between setjmp and longjmp: no destructor is skipped.
bool write_all(png_structp png, png_infop info, const Picture& picture) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_IHDR(png, info, png_uint_32(picture.columns), png_uint_32(picture.rows), 8,
               picture.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 4);
  png_set_filter(png, 0, PNG_FILTER_SUB);
  png_write_info(png, info);
  const std::size_t stride = std::size_t(picture.columns) * std::size_t(picture.channels);
  for (int y = 0; y < picture.rows; ++y)
    png_write_row(png, picture.pixels.data() + std::size_t(y) * stride);
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

std::string encode_png(const Picture& picture) {
  if (picture.columns < 1 || picture.rows < 1 || (picture.channels != 1 && picture.channels != 3))
    throw Error("PNG can't be written: no picture of 1 or 3 channels");
  std::string bytes;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, jump_on_error, ignore_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  bool whole = false;
  if (info) {
    png_set_write_fn(png, &bytes, append, ignore_flush);
    whole = write_all(png, info, picture);
  }
  png_destroy_write_struct(&png, &info);
  if (!whole) throw Error("PNG can't be written: libpng refused it");
  return bytes;
}

void write_png(const std::string& path, const Picture& picture) {
  write_file_whole(path, encode_png(picture));
}

}  // namespace dmise
