#include "core/image/plane_file.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/whole_file.h"
#include "core/image/fits_cards.h"
#include "core/image/plain_image.h"

namespace dmise {
namespace {

std::vector<std::string> plane_cards(const Plane& plane, const FrameHeader& header) {
  const auto bad = std::ranges::find_if_not(plane.pixels, [](float v) { return std::isfinite(v); });
  if (bad != plane.pixels.end())
    throw Error("FITS can't be written: " + plane.name + ": not a finite number at pixel " +
                std::to_string(bad - plane.pixels.begin()));
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
  put_image([&](std::string_view piece) { file.append(piece); }, FitsPlace::primary, plane.pixels,
            plane.columns, cards);
  file.finish();
}

}  // namespace dmise
