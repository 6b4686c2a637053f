#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/files/fits_guard.h"
#include "core/image/fits_cards.h"
#include "core/image/fits_memory.h"

namespace dmise {

/// An image of a FITS file with pixels of any type: the primary one, else that of the first
/// extension that holds one, plain or compressed in tiles (RICE_1, GZIP_1, GZIP_2). Axes of length
/// 1 do not count; a third axis makes planes. Errors are `ConfigError` "NAME: HDU N: KEYWORD:
/// reason, got VALUE", for malicious files too.
class FitsImage {
 public:
  /// `bytes` must outlive the image.
  FitsImage(std::string_view bytes, std::string name);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int planes() const { return planes_; }
  /// Cards of the image's header, then those of the primary header that it lacks.
  const FitsValues& values() const { return values_; }
  /// What was mended in the file to read it.
  const std::vector<std::string>& mended() const { return harmless_.notes(); }

  /// Adds plane `plane` (from 0), scaled by BSCALE and BZERO, to `sum`, rows x columns: NaN where
  /// BLANK or NaN says that there is no value.
  void add_plane(int plane, std::vector<double>& sum);

 private:
  void find_image();
  void read_shape();
  void require_data(bool compressed);
  void read_values();
  [[noreturn]] void fail(const std::string& reason) const;

  std::string name_;
  HarmlessFits harmless_;
  std::string_view bytes_;  // its
  void* memory_;            // CFITSIO keeps the addresses of these two
  std::size_t memory_bytes_;
  Fits fits_;
  int hdu_ = 1;
  int columns_ = 0, rows_ = 0, planes_ = 1, bitpix_ = 0;
  FitsValues values_;
};

}  // namespace dmise
