#pragma once
#include <fitsio.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace dmise::test {

/// A binary table as CFITSIO writes it.
inline std::string fits_table(std::vector<const char*> names, std::vector<const char*> forms,
                              const std::vector<std::vector<double>>& columns) {
  fitsfile* file = nullptr;
  int status = 0;
  std::size_t size = 2880;
  void* memory = std::malloc(size);
  fits_create_memfile(&file, &memory, &size, 2880, std::realloc, &status);
  fits_create_tbl(file, BINARY_TBL, 0, int(names.size()), const_cast<char**>(names.data()),
                  const_cast<char**>(forms.data()), nullptr, "gaia", &status);
  for (std::size_t c = 0; c < columns.size(); ++c)
    fits_write_col(file, TDOUBLE, int(c + 1), 1, 1, long(columns[c].size()),
                   const_cast<double*>(columns[c].data()), &status);
  fits_close_file(file, &status);
  if (status != 0) std::abort();
  const std::string bytes(static_cast<const char*>(memory), size);
  std::free(memory);
  return bytes;
}

/// Barnard's star by Gaia DR3.
inline std::string barnards_table() {
  return fits_table(
      {"dec", "RA", "pmra", "pmdec", "parallax", "phot_g_mean_mag", "bp_rp", "ref_epoch"},
      {"D", "D", "E", "E", "D", "E", "E", "D"},
      {{4.739420051112412},
       {269.44850252543836},
       {-801.551},
       {10362.394},
       {546.9759},
       {8.193974},
       {2.833697},
       {2016.0}});
}

}  // namespace dmise::test
