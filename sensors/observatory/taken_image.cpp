#include "sensors/observatory/taken_image.h"

#include <string_view>
#include <vector>

#include "core/base/units.h"
#include "core/image/fits_cards.h"
#include "core/image/fits_file.h"
#include "core/image/plain_image.h"

namespace dmise {
namespace {

std::string utc_card(const char* key, std::string utc, const char* comment) {
  if (utc.ends_with('Z')) utc.pop_back();
  return text_card(key, utc, comment);
}

std::vector<std::string> part_cards(const TakenImage& image) {
  const FrameHeader& h = image.header;
  const Window& w = image.window;
  std::vector<std::string> cards{
      text_card("BUNIT", "adu", "unit of the pixels: counts of the ADC"),
      text_card("INSTRUME", h.sensor, "sensor"),
      integer_card("FRAMENUM", h.frame, "frame of this sensor, counts from 1"),
      utc_card("DATE-OBS", h.start_utc, "start of the exposure"),
      utc_card("DATE-AVG", h.middle_utc, "middle of the exposure"),
      utc_card("DATE-END", h.end_utc, "end of the exposure"),
      number_card("EXPTIME", h.exposure_s, "[s]"),
      text_card("FILTER", h.band.name, "band"),
      integer_card("XBINNING", w.bin_x, "pixels whose counts are added"),
      integer_card("YBINNING", w.bin_y, ""),
      integer_card("XORGSUBF", w.x, "[binned px] first column of the frame"),
      integer_card("YORGSUBF", w.y, "[binned px] first row of the frame")};
  if (h.observation.ra_rad && h.observation.dec_rad) {
    cards.push_back(
        number_card("RA", *h.observation.ra_rad / deg, "[deg] of the whole frame's centre, ICRS"));
    cards.push_back(number_card("DEC", *h.observation.dec_rad / deg, ""));
  }
  cards.push_back(text_card("CREATOR", h.software, ""));
  return cards;
}

}  // namespace

bool is_whole(const Window& w, int columns, int rows) {
  return w.bin_x == 1 && w.bin_y == 1 && w.x == 0 && w.y == 0 && w.columns == columns &&
         w.rows == rows;
}

std::string fits_of(const TakenImage& image, bool whole) {
  if (whole) return encode_frame(image.counts, image.header);
  std::string file;
  put_image([&](std::string_view piece) { file += piece; }, FitsPlace::primary, image.counts.pixels,
            image.counts.columns, part_cards(image));
  return file;
}

}  // namespace dmise
