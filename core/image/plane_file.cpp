#include "core/image/plane_file.h"

#include <cmath>
#include <span>

#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "core/image/fits_cards.h"
#include "core/image/plain_image.h"

namespace dmise {
namespace {

std::size_t pixel_count(const Plane& plane) {
  return std::size_t(plane.columns) * std::size_t(plane.rows);
}

std::vector<std::string> plane_cards(const Plane& plane, const FrameHeader& header) {
  for (std::size_t i = 0; i < pixel_count(plane); ++i)
    if (!std::isfinite(plane.pixels[i]))
      throw Error("FITS can't be written: " + plane.name + ": not a finite number at pixel " +
                  std::to_string(i));
  auto cards = fits_cards(header);
  cards.insert(cards.begin(), {text_card("EXTNAME", plane.name, plane.what),
                               text_card("BUNIT", plane.unit, "unit of the pixels")});
  return cards;
}

}  // namespace

void write_plane(const std::string& path, const Plane& plane, const FrameHeader& header) {
  std::vector<std::string> cards;
  try {
    cards = plane_cards(plane, header);
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
  WholeFile file(path);
  put_image([&](std::string_view piece) { file.append(piece); }, FitsPlace::primary,
            std::span(plane.pixels, pixel_count(plane)), plane.columns, cards);
  file.finish();
}

}  // namespace dmise
