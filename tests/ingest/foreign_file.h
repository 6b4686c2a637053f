#pragma once
#include <fitsio.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace dmise::test {

/// How CFITSIO writes an image of another camera.
struct ForeignImage {
  int bitpix = SHORT_IMG;  // as in fitsio.h, USHORT_IMG too
  std::vector<long> shape;
  std::vector<double> values;  // by rows, of all planes; NaN where there is none
  std::vector<std::string> cards{};
  bool in_extension = false;
  int compression = 0;  // RICE_1, GZIP_1, GZIP_2, HCOMPRESS_1; 0: none
  double bscale = 1.0, bzero = 0.0;
  long long blank = 0;  // marks integers without a value, if it is not 0
};

template <class T>
void write_pixels(fitsfile* file, int type, const std::vector<double>& from, T none, int& status) {
  std::vector<T> values;
  for (const double v : from) values.push_back(std::isnan(v) ? none : T(v));
  fits_write_imgnull(file, type, 1, LONGLONG(values.size()), values.data(), &none, &status);
}

/// CFITSIO compresses whole numbers only if they are given in their own type.
inline void write_pixels(fitsfile* file, const ForeignImage& image, int& status) {
  const int type = image.compression ? image.bitpix : DOUBLE_IMG;
  if (type == BYTE_IMG) return write_pixels<std::uint8_t>(file, TBYTE, image.values, 255, status);
  if (type == SHORT_IMG) return write_pixels<short>(file, TSHORT, image.values, -32000, status);
  if (type == USHORT_IMG)
    return write_pixels<std::uint16_t>(file, TUSHORT, image.values, 65534, status);
  if (type == LONG_IMG) return write_pixels<int>(file, TINT, image.values, -2000000000, status);
  write_pixels<double>(file, TDOUBLE, image.values, -1e9, status);
}

/// The file's bytes. Throws `Error` with CFITSIO's reason.
inline std::string encoded(const ForeignImage& image) {
  fitsfile* file = nullptr;
  int status = 0;
  std::size_t size = 2880;
  void* memory = std::malloc(size);
  fits_create_memfile(&file, &memory, &size, 2880, std::realloc, &status);
  if (image.in_extension || image.compression) fits_create_img(file, BYTE_IMG, 0, nullptr, &status);
  if (image.compression) fits_set_compression_type(file, image.compression, &status);
  auto shape = image.shape;
  fits_create_img(file, image.bitpix, int(shape.size()), shape.data(), &status);
  if (image.bscale != 1.0 || image.bzero != 0.0) {
    double bscale = image.bscale, bzero = image.bzero;
    fits_write_key(file, TDOUBLE, "BSCALE", &bscale, nullptr, &status);
    fits_write_key(file, TDOUBLE, "BZERO", &bzero, nullptr, &status);
    fits_set_bscale(file, bscale, bzero, &status);
  }
  long long blank = image.blank;
  if (blank != 0) {
    fits_write_key(file, TLONGLONG, "BLANK", &blank, nullptr, &status);
    fits_set_imgnull(file, blank, &status);
  }
  for (const std::string& card : image.cards) fits_write_record(file, card.c_str(), &status);
  write_pixels(file, image, status);
  fits_flush_file(file, &status);
  LONGLONG end = 0;
  fits_get_hduaddrll(file, nullptr, nullptr, &end, &status);
  fits_close_file(file, &status);
  const std::string bytes(static_cast<const char*>(memory), status == 0 ? std::size_t(end) : 0);
  std::free(memory);
  if (status != 0) {
    char reason[FLEN_STATUS] = "";
    fits_get_errstatus(status, reason);
    throw Error(reason);
  }
  return bytes;
}

/// A card as a text.
inline std::string card(const std::string& key, const std::string& value) {
  std::string text = key;
  text.resize(8, ' ');
  return text + "= " + value;
}

}  // namespace dmise::test
