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

void add_cards(Fits& fits, FitsValues& values) {
  int count = 0;
  fits_get_hdrspace(fits.file, &count, nullptr, &fits.status);
  for (int i = 1; i <= count && fits.status == 0; ++i) {
    char card[FLEN_CARD] = "";
    fits_read_record(fits.file, i, card, &fits.status);
    if (fits.status == 0) add_card(values, card);
  }
}

}  // namespace dmise
