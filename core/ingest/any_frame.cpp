#include "core/ingest/any_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/fits_guard.h"
#include "core/base/files/text_file.h"
#include "core/base/formatted.h"
#include "core/detection/light/psf.h"
#include "core/image/fits_block.h"
#include "core/image/fits_image.h"
#include "core/ingest/colour_mosaic.h"
#include "core/ingest/count_map.h"
#include "core/ingest/detector_cards.h"
#include "core/ingest/detector_defects.h"
#include "core/ingest/frame_facts.h"
#include "core/ingest/star_trails.h"

namespace dmise {
namespace {

constexpr double largest_value = 1e30;  // more in a pixel is no light

/// Whether the header is one of this program: a keyword that others do not have.
bool is_own(std::string_view bytes) {
  constexpr std::size_t max_header_bytes = 200 * fits_block_bytes;
  const std::size_t end = std::min(bytes.size(), max_header_bytes);
  for (std::size_t at = 0; at + fits_card_bytes <= end; at += fits_card_bytes)
    if (bytes.substr(at, 10) == "SIMT-BEG= ") return true;
  return false;
}

Frame own_frame(std::string_view bytes, const std::string& name, const FrameChoice& choice) {
  Frame frame = decode_frame(bytes, name);
  if (choice.plane && *choice.plane != 1)
    throw ConfigError(name + ": plane: must be 1, got " + std::to_string(*choice.plane));
  if (!choice.stated.empty())
    throw ConfigError(name + ": " + choice.stated.begin()->first +
                      ": the header of this program's own frame says all");
  return frame;
}

/// The planes of a file that are read, from 0.
struct Planes {
  int first = 0, last = 0;
  int together = 1;  // that are added for one frame, as its colours
};

Planes planes_of(const FitsImage& image, const StandardCards& cards, const FrameChoice& choice,
                 const std::string& name) {
  const int count = image.planes();
  if (choice.plane) {
    const int plane = *choice.plane;
    if (plane < 1 || plane > count)
      throw ConfigError(name + ": plane: must be in 1.." + std::to_string(count) + ", got " +
                        std::to_string(plane));
    return {plane - 1, plane - 1};
  }
  const std::string type = cards.text("CTYPE3");
  const bool colours = count == 3 && (type.empty() || type.starts_with("RGB") ||
                                      type.starts_with("COLO") || type.starts_with("BAND"));
  return {0, count - 1, colours ? count : 1};
}

/// The sum of some planes, NaN where it has no value.
std::vector<double> values_of(FitsImage& image, int first, int together, const StandardCards& cards,
                              const std::string& name) {
  std::vector<double> values;
  for (int plane = first; plane < first + together; ++plane) image.add_plane(plane, values);
  std::size_t without = 0;
  for (double& v : values)
    if (!(std::abs(v) <= largest_value)) {
      v = std::numeric_limits<double>::quiet_NaN();
      ++without;
    }
  if (without == values.size()) throw ConfigError(name + ": no pixel has a value");
  if (without > 0)
    cards.missing("pixels: " + std::to_string(without) + " have no value, and are not used");
  if (together > 1)
    cards.assumed("planes: three are taken for colours, and added; --plane takes one");
  return values;
}

/// The mosaic of a colour camera whose colours are still in one plane; null if it is none.
std::unique_ptr<ColourMosaic> mosaic_of(const StandardCards& cards, const FitsImage& image,
                                        std::span<const double> values, int together,
                                        Threads& threads) {
  if (together > 1 || image.columns() < 2 || image.rows() < 2) return nullptr;
  const auto pattern = cards.first_text({"BAYERPAT", "BAYERPTN", "COLORTYP"});
  if (!pattern || pattern->value == "MONO") return nullptr;
  auto mosaic = std::make_unique<ColourMosaic>(values, image.columns(), threads);
  if (const auto& r = mosaic->responses())
    cards.assumed(pattern->key +
                  formatted(": the colours of the mosaic are evened: responses %.2f %.2f %.2f %.2f",
                            (*r)[0], (*r)[1], (*r)[2], (*r)[3]));
  else
    cards.assumed(pattern->key +
                  ": the colours of the mosaic have the same sky now; too few bright "
                  "pixels show their responses");
  return mosaic;
}

/// A stated value must be one, and a keyword that nothing reads is noted.
void check_stated(const StandardCards& of_planes, const StandardCards& cards,
                  const FrameChoice& choice, const std::string& name) {
  for (const auto& [key, value] : choice.stated) {
    cards.require_accepted(key, name);
    if (!cards.was_read(key) && !of_planes.was_read(key))
      cards.missing(key + ": is stated, but nothing reads it here");
  }
}

Frame foreign_frame(FitsImage& image, const FitsValues& values, const StandardCards& of_planes,
                    const PlanePlace& place, int together, const FrameChoice& choice,
                    const std::string& name, Threads& threads) {
  Frame frame;
  const StandardCards cards(values, frame.notes);
  for (const std::string& note : image.mended()) cards.assumed(note);
  auto pixels = values_of(image, place.plane, together, cards, name);
  leave_out_overscan(cards, image.columns(), image.rows(), pixels);
  const auto mosaic = mosaic_of(cards, image, pixels, together, threads);
  std::vector<double> evened;
  if (mosaic) evened = mosaic->evened();
  auto& used = mosaic ? evened : pixels;
  leave_out_bright_edges(cards, image.columns(), image.rows(), used);
  const CountMap map = choose_count_map(used, image.columns());
  frame.counts = to_counts(used, image.columns(), map, frame.unusable);
  frame.count_zero = map.zero;
  frame.count_step = map.step;
  set_facts(cards, place, image.columns(), image.rows(), frame.header);
  set_detector(cards, {pixels, map, together, mosaic.get()}, frame.counts, threads, frame.header);
  leave_out_bleeding(frame, threads);
  if (set_star_images(cards, frame.counts, threads, frame.header))
    leave_out_hot_pixels(sigma_with_pixel(frame.header.psf_fwhm_px), frame, threads);
  check_stated(of_planes, cards, choice, name);
  return frame;
}

}  // namespace

void decode_frames(std::string_view bytes, const std::string& name, const FrameChoice& choice,
                   Threads& threads, const TakeFrame& take) {
  if (is_own(bytes)) {
    take(own_frame(bytes, name, choice));
    return;
  }
  FitsImage image(bytes, name);
  FitsValues values = image.values();
  for (const auto& [key, value] : choice.stated) values[key] = value;
  FrameNotes unused;
  const StandardCards of_planes(values, unused);
  const Planes planes = planes_of(image, of_planes, choice, name);
  for (int plane = planes.first; plane <= planes.last; plane += planes.together)
    take(foreign_frame(image, values, of_planes, {plane, image.planes() / planes.together},
                       planes.together, choice, name, threads));
}

void read_frames_of(const std::string& path, const FrameChoice& choice, Threads& threads,
                    const TakeFrame& take) {
  decode_frames(read_fits_file(path), path, choice, threads, take);
}

Frame read_any_frame(const std::string& path, const FrameChoice& choice, Threads& threads) {
  std::optional<Frame> only;
  read_frames_of(path, choice, threads, [&](const Frame& frame) {
    if (only) throw ConfigError(path + ": NAXIS3: holds several frames; --plane N takes one");
    only = frame;
  });
  return std::move(*only);
}

}  // namespace dmise
