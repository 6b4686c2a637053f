#pragma once
#include <fitsio.h>

#include <string>

namespace dmise {

/// An open FITS file, closed by its destructor.
struct Fits {
  fitsfile* file = nullptr;
  int status = 0;

  Fits() = default;
  Fits(const Fits&) = delete;
  Fits& operator=(const Fits&) = delete;
  ~Fits();
  std::string reason() const;
};

}  // namespace dmise
