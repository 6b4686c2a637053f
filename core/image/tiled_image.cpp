#include "core/image/tiled_image.h"

#include <algorithm>
#include <vector>

#include "core/base/error.h"
#include "core/image/fits_block.h"
#include "core/image/fits_cards.h"
#include "core/image/rice.h"

namespace dmise {
namespace {

constexpr int rice_block = 32;  // pixels that share a code
constexpr std::uint16_t zero = 32768;

void put_big_endian(std::string& bytes, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += char(number >> shift);
}

struct Compressed {
  std::string table, heap;
  std::size_t longest = 0;  // bytes of a row
};

/// `row_of(y)` gives the pixels of a row as they are coded.
template <class RowOf>
Compressed compress(std::size_t rows, const RowOf& row_of) {
  Compressed out;
  for (std::size_t y = 0; y < rows; ++y) {
    const std::size_t begin = out.heap.size();
    rice_encode(row_of(y), rice_block, out.heap);
    const std::size_t size = out.heap.size() - begin;
    put_big_endian(out.table, std::uint32_t(size));
    put_big_endian(out.table, std::uint32_t(begin));
    out.longest = std::max(out.longest, size);
    if (out.heap.size() >= 0x7fffffffu) throw Error("FITS can't be written: more than 2 GiB");
  }
  return out;
}

void append(std::string& file, const Compressed& image, int columns, std::size_t rows,
            int pixel_bytes, std::span<const std::string> cards) {
  const std::string form = "1PB(" + std::to_string(image.longest) + ")";
  std::vector<std::string> all = {
      text_card("XTENSION", "BINTABLE", "a compressed image"),
      integer_card("BITPIX", 8, ""),
      integer_card("NAXIS", 2, ""),
      integer_card("NAXIS1", 8, "bytes of a table row"),
      integer_card("NAXIS2", std::int64_t(rows), "table rows: one for each row of the image"),
      integer_card("PCOUNT", std::int64_t(image.heap.size()), "bytes of the compressed rows"),
      integer_card("GCOUNT", 1, ""),
      integer_card("TFIELDS", 1, ""),
      text_card("TTYPE1", "COMPRESSED_DATA", ""),
      text_card("TFORM1", form, ""),
      flag_card("ZIMAGE", true, "the table holds an image"),
      integer_card("ZBITPIX", 8 * pixel_bytes, ""),
      integer_card("ZNAXIS", 2, ""),
      integer_card("ZNAXIS1", columns, ""),
      integer_card("ZNAXIS2", std::int64_t(rows), ""),
      integer_card("ZTILE1", columns, "a tile is a row"),
      integer_card("ZTILE2", 1, ""),
      text_card("ZCMPTYPE", "RICE_1", "without loss"),
      text_card("ZNAME1", "BLOCKSIZE", ""),
      integer_card("ZVAL1", rice_block, "pixels to a block"),
      text_card("ZNAME2", "BYTEPIX", ""),
      integer_card("ZVAL2", pixel_bytes, "bytes of a pixel"),
  };
  if (pixel_bytes == 2) {
    all.push_back(integer_card("BZERO", zero, "16-bit unsigned"));
    all.push_back(integer_card("BSCALE", 1, ""));
  }
  all.insert(all.end(), cards.begin(), cards.end());
  file += fits_header(all);
  file += image.table;
  file += image.heap;
  file += fits_padding(file.size(), '\0');
}

}  // namespace

std::string empty_primary() {
  return fits_header(std::vector{flag_card("SIMPLE", true, "FITS Standard 4.0"),
                                 integer_card("BITPIX", 8, ""), integer_card("NAXIS", 0, ""),
                                 flag_card("EXTEND", true, "the image follows")});
}

void append_rice_image(std::string& file, std::span<const std::uint16_t> pixels, int columns,
                       std::span<const std::string> cards) {
  const auto width = std::size_t(columns);
  const std::size_t rows = pixels.size() / width;
  std::vector<std::uint16_t> row(width);
  const auto image = compress(rows, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) row[x] = std::uint16_t(pixels[y * width + x] - zero);
    return std::span<const std::uint16_t>(row);
  });
  append(file, image, columns, rows, 2, cards);
}

void append_rice_image(std::string& file, std::span<const std::uint8_t> pixels, int columns,
                       std::span<const std::string> cards) {
  const auto width = std::size_t(columns);
  const std::size_t rows = pixels.size() / width;
  const auto image =
      compress(rows, [&](std::size_t y) { return pixels.subspan(y * width, width); });
  append(file, image, columns, rows, 1, cards);
}

}  // namespace dmise
