#include "core/image/fits_memory.h"

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

}  // namespace dmise
