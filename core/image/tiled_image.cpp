#include "core/image/tiled_image.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "core/base/error.h"

namespace dmise {
namespace {

/// Returns the errno of extending the file, which CFITSIO does not report.
int errno_of_extending(const std::string& path) {
  const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) return errno;
  const int reason = posix_fallocate(file, lseek(file, 0, SEEK_END), 1 << 20);
  ::close(file);
  return reason;
}

}  // namespace

TiledFile::TiledFile(std::string path) : path_(std::move(path)) {
  if (path_.starts_with(' ')) path_ = "./" + path_;  // CFITSIO skips leading blanks
  if (path_.size() >= FLEN_FILENAME) throw Error("can't be written: name too long");
  unlink(path_.c_str());  // left by a killed process
  errno = 0;
  fits_create_diskfile(&fits_.file, path_.c_str(), &fits_.status);
  fits_create_img(fits_.file, BYTE_IMG, 0, nullptr, &fits_.status);
  require_ok();
  errno = 0;  // set by CFITSIO's test for an existing file
}

TiledFile::~TiledFile() {
  if (!closed_) unlink(path_.c_str());
}

void TiledFile::add(std::span<const std::uint16_t> pixels, int columns,
                    std::span<const std::string> cards) {
  add(USHORT_IMG, TUSHORT, pixels.data(), pixels.size(), columns, cards);
}

void TiledFile::add(std::span<const std::uint8_t> pixels, int columns,
                    std::span<const std::string> cards) {
  add(BYTE_IMG, TBYTE, pixels.data(), pixels.size(), columns, cards);
}

void TiledFile::add(int image_type, int data_type, const void* pixels, std::size_t count,
                    int columns, std::span<const std::string> cards) {
  fitsfile* const file = fits_.file;
  int* const status = &fits_.status;
  std::array<long, 2> shape{columns, long(count) / columns}, tile{columns, 1};
  fits_set_compression_type(file, RICE_1, status);
  fits_set_tile_dim(file, 2, tile.data(), status);
  fits_create_img(file, image_type, 2, shape.data(), status);
  for (const std::string& card : cards) fits_write_record(file, card.c_str(), status);
  fits_write_img(file, data_type, 1, LONGLONG(count), const_cast<void*>(pixels), status);
  require_ok();
}

void TiledFile::close() {
  LONGLONG end = 0;
  fits_flush_file(fits_.file, &fits_.status);
  fits_get_hduaddrll(fits_.file, nullptr, nullptr, &end, &fits_.status);
  fits_close_file(std::exchange(fits_.file, nullptr), &fits_.status);
  // CFITSIO writes the last block on close without checking for errors.
  std::error_code failed;
  if (fits_.status == 0 && std::filesystem::file_size(path_, failed) != std::uintmax_t(end))
    fits_.status = WRITE_ERROR;
  errno = 0;
  require_ok();
  closed_ = true;
}

void TiledFile::require_ok() {
  if (fits_.status == 0) return;
  const int reason = errno != 0 ? errno : errno_of_extending(path_);
  throw Error("can't be written: " +
              (reason != 0 ? std::string(std::strerror(reason)) : fits_.reason()));
}

}  // namespace dmise
