#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace dmise {

/// The bytes of a FITS file as CFITSIO 4.2 reads them without harm. What other programs read, too,
/// is mended in a copy, with a note that names the card.
class HarmlessFits {
 public:
  /// Mends bytes that are not printable ASCII, numbers longer than any that CFITSIO converts,
  /// headers and data whose last block is cut off in its padding, and leaves out what follows the
  /// last HDU. Throws `ConfigError` `name: KEYWORD: reason` for what CFITSIO crashes on otherwise:
  /// a text where it reads a number, more than 99 axes, sizes of tiles and blocks that are not
  /// whole numbers > 0. Other errors are left to CFITSIO. `bytes` must outlive this.
  HarmlessFits(std::string_view bytes, const std::string& name);

  std::string_view bytes() const { return mended_.empty() ? given_ : std::string_view(mended_); }
  /// Number of bytes that the headers ask for, up to the first header without an end. CFITSIO takes
  /// a file in memory to be that long once it has counted the HDUs, and reads beyond the end of a
  /// shorter one.
  std::size_t asked() const { return asked_; }
  /// What was mended or left out, "KEYWORD: ..".
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::string_view given_;
  std::string mended_;  // empty: nothing is to mend
  std::size_t asked_ = 0;
  std::vector<std::string> notes_;
};

/// Throws `ConfigError` `name: is truncated: N of ASKED bytes` if there are fewer than `asked`.
void require_bytes(std::string_view bytes, std::size_t asked, const std::string& name);

/// Reads a FITS file, decompressed if it is gzip, to the end of the last HDU that its headers
/// announce and a block more. Throws as `read_text_file` does.
std::string read_fits_file(const std::string& path);

}  // namespace dmise
