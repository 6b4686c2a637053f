#include "core/image/plane_file.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/text_file.h"
#include "core/image/fits_cards.h"
#include "core/image/fits_memory.h"

namespace dmise {

std::string encode_plane(const Plane& plane, const FrameHeader& header) {
  const std::size_t count = std::size_t(plane.columns) * std::size_t(plane.rows);
  for (std::size_t i = 0; i < count; ++i)
    if (!std::isfinite(plane.pixels[i]))
      throw Error("FITS can't be written: " + plane.name + ": not a finite number at pixel " +
                  std::to_string(i));
  auto cards = fits_cards(header);
  cards.insert(cards.begin(), {text_card("EXTNAME", plane.name, plane.what),
                               text_card("BUNIT", plane.unit, "unit of the pixels")});
  constexpr std::size_t fits_block = 2880;
  FitsWriter fits((cards.size() + 64) * 80 + 4 * count + 3 * fits_block);
  fits.image(FLOAT_IMG, plane.columns, plane.rows, cards, TFLOAT, plane.pixels);
  return fits.bytes();
}

void write_plane(const std::string& path, const Plane& plane, const FrameHeader& header) {
  std::string bytes;
  try {
    bytes = encode_plane(plane, header);
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
  write_file_whole(path, bytes);
}

}  // namespace dmise
