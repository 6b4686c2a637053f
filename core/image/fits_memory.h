#pragma once
#include <fitsio.h>

#include <cstddef>
#include <span>
#include <string>

namespace dmise {

/// An open FITS file; closed on the way out whatever happens.
struct Fits {
  fitsfile* file = nullptr;
  int status = 0;

  Fits() = default;
  Fits(const Fits&) = delete;
  Fits& operator=(const Fits&) = delete;
  ~Fits();
  std::string reason() const;
};

/// A FITS file that is written into memory. Equal calls give equal bytes. Methods throw `Error`.
class FitsWriter {
 public:
  /// `most_bytes`: room that the whole file surely fits in.
  explicit FitsWriter(std::size_t most_bytes);
  FitsWriter(const FitsWriter&) = delete;
  FitsWriter& operator=(const FitsWriter&) = delete;
  ~FitsWriter();

  /// A new image of CFITSIO's type `image_type` with pixels of `pixel_type`, first row first.
  void image(int image_type, int columns, int rows, std::span<const std::string> cards,
             int pixel_type, const void* pixels);
  /// Closes the file and returns it.
  std::string bytes();

 private:
  void check();
  void* data_ = nullptr;
  std::size_t size_ = 0;
  Fits fits_;
};

}  // namespace dmise
