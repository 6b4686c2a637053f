#pragma once
#include <fitsio.h>

#include <string>

#include "core/image/fits_cards.h"

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

/// Adds the cards of the current HDU to `values`; keywords that are there keep their values.
/// `status` says whether all could be read.
void add_cards(Fits& fits, FitsValues& values);

}  // namespace dmise
