#include "core/ingest/any_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/error.h"
#include "core/base/text_file.h"
#include "core/image/fits_block.h"
#include "core/ingest/count_map.h"
#include "core/ingest/detector_cards.h"
#include "core/ingest/fits_image.h"
#include "core/ingest/frame_facts.h"
#include "core/ingest/star_trails.h"

namespace dmise {
namespace {

constexpr double largest_value = 1e30;  // of a pixel; more is no light

/// Whether the header is one of this program: a keyword that others do not have.
bool is_own(std::string_view bytes) {
  constexpr std::size_t most_header_bytes = 200 * fits_block_bytes;
  const std::size_t end = std::min(bytes.size(), most_header_bytes);
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

/// What the planes of a file are.
struct Planes {
  int first = 0, last = 0;
  bool added = false;  // they are colours of one frame
};

Planes planes_of(const FitsImage& image, const StandardCards& cards, const FrameChoice& choice,
                 const std::string& name) {
  const int count = image.planes();
  if (choice.plane) {
    const int plane = *choice.plane;
    if (plane < 1 || plane > count)
      throw ConfigError(name + ": plane: must be in 1.." + std::to_string(count) + ", got " +
                        std::to_string(plane));
    return {plane - 1, plane - 1, false};
  }
  const std::string type = cards.text("CTYPE3");
  const bool colours = count == 3 && (type.empty() || type.starts_with("RGB") ||
                                      type.starts_with("COLO") || type.starts_with("BAND"));
  return {0, count - 1, colours};
}

/// The values of some planes, NaN where there is none.
std::vector<double> values_of(FitsImage& image, const Planes& planes, const StandardCards& cards,
                              const std::string& name) {
  std::vector<double> values;
  for (int plane = planes.first; plane <= planes.last; ++plane) image.add_plane(plane, values);
  std::size_t without = 0;
  for (double& v : values)
    if (!(std::abs(v) <= largest_value)) {
      v = std::numeric_limits<double>::quiet_NaN();
      ++without;
    }
  if (without == values.size()) throw ConfigError(name + ": no pixel has a value");
  if (without > 0)
    cards.missing("pixels: " + std::to_string(without) + " have no value, and are not used");
  if (planes.last > planes.first)
    cards.assumed("planes: three are taken for colours, and added; --plane takes one");
  return values;
}

Frame foreign_frame(FitsImage& image, const FitsValues& values, const Planes& planes,
                    const PlanePlace& place, const std::string& name, Threads& threads) {
  Frame frame;
  const StandardCards cards(values, frame.notes);
  const auto pixels = values_of(image, planes, cards, name);
  const CountMap map = choose_count_map(pixels, image.columns());
  frame.counts = to_counts(pixels, image.columns(), map, frame.unusable);
  set_facts(cards, place, image.columns(), image.rows(), frame.header);
  const CountSource source{pixels, map, planes.last - planes.first + 1};
  set_detector(cards, source, frame.counts, threads, frame.header);
  set_star_images(cards, frame.counts, threads, frame.header);
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
  const Planes planes = planes_of(image, StandardCards(values, unused), choice, name);
  const int frames = planes.added ? 1 : image.planes();
  for (int plane = planes.first; plane <= (planes.added ? planes.first : planes.last); ++plane) {
    const Planes own = planes.added ? planes : Planes{plane, plane, false};
    const PlanePlace place{planes.added ? 0 : plane, frames};
    take(foreign_frame(image, values, own, place, name, threads));
  }
}

void read_frames_of(const std::string& path, const FrameChoice& choice, Threads& threads,
                    const TakeFrame& take) {
  decode_frames(read_text_file(path), path, choice, threads, take);
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
