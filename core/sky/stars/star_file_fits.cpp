// Gaia's columns in a FITS binary table.
#include <fitsio.h>

#include <algorithm>
#include <array>
#include <string>

#include "core/base/error.h"
#include "core/base/files/fits_guard.h"
#include "core/sky/stars/gaia_stars.h"
#include "core/sky/stars/star_file.h"

namespace dmise {
namespace {

/// A FITS file in memory.
class FitsTable {
 public:
  FitsTable(std::string_view bytes, const std::string& name)
      : name_(name), harmless_(bytes, name), size_(harmless_.bytes().size()) {
    require_bytes(harmless_.bytes(), harmless_.asked(), name);
    bytes_ = const_cast<char*>(harmless_.bytes().data());  // it is opened for reading
    fits_open_memfile(&file_, "stars", READONLY, &bytes_, &size_, 0, nullptr, &status_);
    check("no FITS file");
    int units = 0;
    fits_get_num_hdus(file_, &units, &status_);
    check("no FITS file");
    for (int unit = 2; unit <= units; ++unit) {
      int kind = 0;
      fits_movabs_hdu(file_, unit, &kind, &status_);
      check("a header can't be read");
      if (kind == BINARY_TBL) return;
    }
    status_ = NOT_BTABLE;
    check("no binary table");
  }
  FitsTable(const FitsTable&) = delete;
  FitsTable& operator=(const FitsTable&) = delete;
  ~FitsTable() {
    int ignored = 0;
    if (file_) fits_close_file(file_, &ignored);
    fits_clear_errmsg();
  }

  long rows() {
    long rows = 0;
    fits_get_num_rows(file_, &rows, &status_);
    check("the table's header can't be read");
    return rows;
  }
  /// Number of a column, 0 if there is none.
  int column(std::string name, bool is_needed) {
    int number = 0, type = 0;
    long repeat = 0, width = 0;
    if (fits_get_colnum(file_, CASEINSEN, name.data(), &number, &status_) != 0) {
      status_ = 0;
      fits_clear_errmsg();
      if (is_needed) throw ConfigError(name_ + ": the table has no column " + name);
      return 0;
    }
    fits_get_coltype(file_, number, &type, &repeat, &width, &status_);
    check("the table's header can't be read");
    if (type < 0 || repeat != 1 || type == TSTRING || type == TCOMPLEX || type == TDBLCOMPLEX)
      throw ConfigError(name_ + ": column " + name + " must hold one number a row");
    return number;
  }
  void read(int column, long first, std::vector<double>& values) {
    double missing = GaiaRow::missing;
    int any_missing = 0;  // CFITSIO sets it unasked
    fits_read_col(file_, TDOUBLE, column, first + 1, 1, long(values.size()), &missing,
                  values.data(), &any_missing, &status_);
    check("the table is cut short");
  }

 private:
  void check(const char* what) {
    if (status_ == 0) return;
    std::array<char, FLEN_STATUS> text{};
    fits_get_errstatus(status_, text.data());
    const std::string why = name_ + ": " + what + " (" + text.data() + ")";
    if (file_) fits_close_file(file_, &(status_ = 0));
    file_ = nullptr;
    fits_clear_errmsg();
    throw ConfigError(why);
  }

  const std::string& name_;
  HarmlessFits harmless_;
  void* bytes_ = nullptr;
  std::size_t size_;
  fitsfile* file_ = nullptr;
  int status_ = 0;
};

}  // namespace

StarReading parse_gaia_fits(std::string_view bytes, const std::string& name) {
  FitsTable table(bytes, name);
  std::array<int, gaia_columns.size()> number{};
  for (std::size_t c = 0; c < gaia_columns.size(); ++c)
    number[c] = table.column(gaia_columns[c].name, c < needed_gaia_columns);
  constexpr long most_at_once = 1 << 16;
  const long rows = table.rows();
  StarReading reading;
  std::vector<double> values;
  std::vector<GaiaRow> some;
  for (long first = 0; first < rows; first += most_at_once) {
    const auto count = std::size_t(std::min(most_at_once, rows - first));
    some.assign(count, {});
    values.resize(count);
    for (std::size_t c = 0; c < gaia_columns.size(); ++c) {
      if (number[c] == 0) continue;
      table.read(number[c], first, values);
      for (std::size_t i = 0; i < count; ++i) some[i].*gaia_columns[c].value = values[i];
    }
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = std::uint32_t(first + long(i) + 1);
      if (const char* why = append_gaia_star(reading.catalogue, row, some[i]))
        reading.problems.push_back(name + ": row " + std::to_string(row) + ": " + why);
    }
  }
  return reading;
}

}  // namespace dmise
