#include "core/image/fits_image.h"

#include <array>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/image/fits_block.h"
#include "core/image/tile_guard.h"

namespace dmise {
namespace {

constexpr int max_axes = 99;  // CFITSIO has no more
constexpr int max_compressed_axes = 6;
constexpr LONGLONG longest_side = 1 << 16, max_planes = 1 << 20;
// gzip compresses at best 1032 to 1: a file that claims more is malicious.
constexpr double max_bytes_per_byte = 1040;

std::string_view require_fits(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with("SIMPLE  =")) throw ConfigError(name + ": SIMPLE: not a FITS file");
  return bytes;
}

}  // namespace

FitsImage::FitsImage(std::string_view bytes, std::string name)
    : name_(std::move(name)),
      harmless_(require_fits(bytes, name_), name_),
      bytes_(harmless_.bytes()),
      memory_(const_cast<char*>(bytes_.data())),  // opened read-only
      memory_bytes_(bytes_.size()) {
  fits_open_memfile(&fits_.file, "frame", READONLY, &memory_, &memory_bytes_, 0, nullptr,
                    &fits_.status);
  if (fits_.status != 0) throw ConfigError(name_ + ": not a FITS file: " + fits_.reason());
  find_image();
  read_shape();
  const bool compressed = fits_is_compressed_image(fits_.file, &fits_.status) != 0;
  require_data(compressed);
  read_values();
  if (compressed) require_harmless_tiles(fits_, values_, name_ + ": HDU " + std::to_string(hdu_));
}

void FitsImage::find_image() {
  for (;; ++hdu_) {
    int type = 0, axes = 0;
    fits_movabs_hdu(fits_.file, hdu_, &type, &fits_.status);
    if (fits_.status != 0) throw ConfigError(name_ + ": NAXIS: contains no image");
    if (type != IMAGE_HDU && !fits_is_compressed_image(fits_.file, &fits_.status)) continue;
    fits_get_img_dim(fits_.file, &axes, &fits_.status);
    if (fits_.status != 0) fail("is not an image: " + fits_.reason());
    if (axes > 0) return;
  }
}

void FitsImage::read_shape() {
  int axes = 0;
  std::array<LONGLONG, max_axes> sides{};
  fits_get_img_dim(fits_.file, &axes, &fits_.status);
  const bool compressed = fits_is_compressed_image(fits_.file, &fits_.status) != 0;
  const int most = compressed ? max_compressed_axes : max_axes;
  if (fits_.status == 0 && axes > most)
    fail("NAXIS: must be at most " + std::to_string(most) + ", got " + std::to_string(axes));
  fits_get_img_paramll(fits_.file, max_axes, &bitpix_, &axes, sides.data(), &fits_.status);
  if (fits_.status != 0) fail("is not an image: " + fits_.reason());
  std::array<int, 3> shape{1, 1, 1};
  std::size_t used = 0;
  for (int i = 0; i < axes; ++i) {
    const LONGLONG side = sides[std::size_t(i)];
    const std::string key = "NAXIS" + std::to_string(i + 1);
    if (side == 1 && i >= 2) continue;
    if (used == 3) fail(key + ": a fourth axis must be 1 long, got " + std::to_string(side));
    const LONGLONG longest = used < 2 ? longest_side : max_planes;
    if (side < 1 || side > longest)
      fail(key + ": must be in 1.." + std::to_string(longest) + ", got " + std::to_string(side));
    shape[used++] = int(side);
  }
  if (axes < 2) fail("NAXIS: must be 2 or more, got " + std::to_string(axes));
  columns_ = shape[0];
  rows_ = shape[1];
  planes_ = shape[2];
}

void FitsImage::require_data(bool compressed) {
  LONGLONG end = 0;
  fits_get_hduaddrll(fits_.file, nullptr, nullptr, &end, &fits_.status);
  if (fits_.status != 0) throw ConfigError(name_ + ": not a FITS file: " + fits_.reason());
  require_bytes(bytes_, std::size_t(end), name_);
  const double bytes = double(columns_) * rows_ * planes_ * std::abs(bitpix_) / 8;
  if (bytes > double(bytes_.size()) * (compressed ? max_bytes_per_byte : 1.0))
    fail("NAXIS1: the image is larger than the file can hold");
}

void FitsImage::read_values() {
  add_cards(fits_, values_);
  if (fits_.status != 0) fail("header can't be read: " + fits_.reason());
  if (hdu_ == 1) return;
  fits_movabs_hdu(fits_.file, 1, nullptr, &fits_.status);
  add_cards(fits_, values_);
  fits_movabs_hdu(fits_.file, hdu_, nullptr, &fits_.status);
  if (fits_.status != 0) fail("header can't be read: " + fits_.reason());
}

void FitsImage::add_plane(int plane, std::vector<double>& sum) {
  const std::size_t size = std::size_t(columns_) * std::size_t(rows_);
  sum.resize(size, 0.0);
  std::vector<double> values(size);
  double none = std::numeric_limits<double>::quiet_NaN();
  int any_null = 0;
  fits_read_img(fits_.file, TDOUBLE, 1 + LONGLONG(plane) * LONGLONG(size), LONGLONG(size), &none,
                values.data(), &any_null, &fits_.status);
  if (fits_.status != 0) fail("pixels can't be read: " + fits_.reason());
  for (std::size_t i = 0; i < size; ++i) sum[i] += values[i];
}

void FitsImage::fail(const std::string& reason) const {
  throw ConfigError(name_ + ": HDU " + std::to_string(hdu_) + ": " + reason);
}

}  // namespace dmise
