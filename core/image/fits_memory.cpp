#include "core/image/fits_memory.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "core/base/error.h"
#include "core/base/memory.h"

namespace dmise {
Fits::~Fits() {
  int ignored = 0;
  if (file) fits_close_file(file, &ignored);
  fits_clear_errmsg();
}

std::string Fits::reason() const {
  char text[FLEN_STATUS] = "";
  fits_get_errstatus(status, text);
  return text;
}

// CFITSIO takes the memory's end for the file's and can't seek beyond it: so there is room for the
// whole file, zeros, from the start, and where the file ends is asked afterwards.
FitsWriter::FitsWriter(std::size_t most_bytes)
    : data_(std::calloc(1, most_bytes)), size_(most_bytes) {
  if (!data_) throw Error("FITS can't be written: out of memory");
  fits_create_memfile(&fits_.file, &data_, &size_, std::size_t(1) << 20, std::realloc,
                      &fits_.status);
}

FitsWriter::~FitsWriter() {
  int ignored = 0;
  if (fits_.file) fits_close_file(fits_.file, &ignored);
  fits_.file = nullptr;
  std::free(data_);
}

void FitsWriter::check() {
  if (fits_.status != 0) throw Error("FITS can't be written: " + fits_.reason());
}

void FitsWriter::image(int image_type, int columns, int rows, std::span<const std::string> cards,
                       int pixel_type, const void* pixels) {
  std::array<long, 2> shape = {columns, rows};
  fits_create_img(fits_.file, image_type, 2, shape.data(), &fits_.status);
  for (const std::string& card : cards) fits_write_record(fits_.file, card.c_str(), &fits_.status);
  // CFITSIO only reads the pixels; its interface predates const.
  fits_write_img(fits_.file, pixel_type, 1, LONGLONG(columns) * rows, const_cast<void*>(pixels),
                 &fits_.status);
  fits_flush_file(fits_.file, &fits_.status);
  check();
}

std::string FitsWriter::bytes() {
  LONGLONG end = 0;
  fits_get_hduaddrll(fits_.file, nullptr, nullptr, &end, &fits_.status);
  check();
  fits_close_file(fits_.file, &fits_.status);
  fits_.file = nullptr;
  check();
  // Moved piece by piece: a frame is not held twice.
  constexpr std::size_t piece = std::size_t(1) << 20;
  std::string bytes;
  bytes.reserve(std::size_t(end));
  auto* from = static_cast<char*>(data_);
  for (std::size_t done = 0; done < std::size_t(end); done += piece) {
    const std::size_t count = std::min(piece, std::size_t(end) - done);
    bytes.append(from + done, count);
    release_pages(from + done, count);
  }
  return bytes;
}

}  // namespace dmise
