#include "core/image/plain_image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "core/image/fits_cards.h"

namespace dmise {
namespace {

constexpr std::uint16_t zero = 32768;

std::vector<std::string> header_cards(FitsPlace place, int bits, std::size_t columns,
                                      std::size_t rows, std::span<const std::string> cards) {
  std::vector<std::string> all = {place == FitsPlace::primary
                                      ? flag_card("SIMPLE", true, "FITS Standard 4.0")
                                      : text_card("XTENSION", "IMAGE", ""),
                                  integer_card("BITPIX", bits, ""), integer_card("NAXIS", 2, ""),
                                  integer_card("NAXIS1", std::int64_t(columns), "columns"),
                                  integer_card("NAXIS2", std::int64_t(rows), "rows")};
  if (place == FitsPlace::primary) {
    all.push_back(flag_card("EXTEND", true, "extensions may follow"));
  } else {
    all.push_back(integer_card("PCOUNT", 0, ""));
    all.push_back(integer_card("GCOUNT", 1, ""));
  }
  if (bits == 16) {
    all.push_back(integer_card("BZERO", zero, "16-bit unsigned"));
    all.push_back(integer_card("BSCALE", 1, ""));
  }
  all.insert(all.end(), cards.begin(), cards.end());
  return all;
}

std::uint8_t stored(std::uint8_t pixel) { return pixel; }
std::uint16_t stored(std::uint16_t pixel) {
  const std::uint16_t shifted = pixel ^ zero;
  return std::uint16_t(shifted << 8 | shifted >> 8);
}
std::uint32_t stored(float pixel) { return __builtin_bswap32(std::bit_cast<std::uint32_t>(pixel)); }
static_assert(std::endian::native == std::endian::little);

template <class T>
void put(const ByteSink& file, FitsPlace place, int bits, std::span<const T> pixels, int columns,
         std::span<const std::string> cards) {
  file(fits_header(header_cards(place, bits, std::size_t(columns),
                                pixels.size() / std::size_t(columns), cards)));
  using Stored = decltype(stored(T{}));
  std::array<Stored, 65536 / sizeof(Stored)> piece;
  for (std::size_t done = 0; done < pixels.size(); done += piece.size()) {
    const auto part = pixels.subspan(done, std::min(piece.size(), pixels.size() - done));
    for (std::size_t i = 0; i < part.size(); ++i) piece[i] = stored(part[i]);
    file({reinterpret_cast<const char*>(piece.data()), part.size() * sizeof(Stored)});
  }
  file(fits_padding(pixels.size_bytes(), '\0'));
}

}  // namespace

std::vector<std::string> count_image_cards(int columns, int rows,
                                           std::span<const std::string> cards) {
  return header_cards(FitsPlace::primary, 16, std::size_t(columns), std::size_t(rows), cards);
}

void put_image(const ByteSink& file, FitsPlace place, std::span<const std::uint16_t> pixels,
               int columns, std::span<const std::string> cards) {
  put(file, place, 16, pixels, columns, cards);
}

void put_image(const ByteSink& file, FitsPlace place, std::span<const std::uint8_t> pixels,
               int columns, std::span<const std::string> cards) {
  put(file, place, 8, pixels, columns, cards);
}

void put_image(const ByteSink& file, FitsPlace place, std::span<const float> pixels, int columns,
               std::span<const std::string> cards) {
  put(file, place, -32, pixels, columns, cards);
}

}  // namespace dmise
