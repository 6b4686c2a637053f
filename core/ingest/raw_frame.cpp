#include "core/ingest/raw_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/fits_guard.h"
#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/image/fits_image.h"
#include "core/ingest/detector_defects.h"
#include "core/ingest/standard_cards.h"

namespace dmise {
namespace {

constexpr double largest_raw_value = 1e30;  // more is no light
constexpr float no_raw_value = std::numeric_limits<float>::quiet_NaN();

/// A number of a header in a range; empty if there is none, or another.
std::optional<double> in_range(const std::optional<StandardCards::Named<double>>& stated,
                               double low, double high, double unit, const StandardCards& cards) {
  if (!stated) return std::nullopt;
  if (stated->value >= low && stated->value <= high) return stated->value * unit;
  cards.reject(stated->key, formatted("must be in %g..%g", low, high));
  return std::nullopt;
}

void set_facts_of(const StandardCards& cards, RawFrame& frame) {
  for (const char* key : {"IMAGETYP", "FRAME", "OBSTYPE", "FRAMETYP"}) {
    frame.kind = frame_kind_of(cards.text(key));
    if (frame.kind != FrameKind::unknown) break;
  }
  const auto number = [&](std::initializer_list<const char*> keys, double low, double high,
                          double unit) {
    return in_range(cards.first_number(keys), low, high, unit, cards);
  };
  frame.exposure_s = number({"EXPTIME", "EXPOSURE", "XPOSURE"}, 0.0, 1e6, 1.0);
  frame.temperature_c = number(
      {"CCD-TEMP", "CCD_TEMP", "CCDTEMP", "DET-TEMP", "DETTEMP", "SET-TEMP"}, -273.15, 100.0, 1.0);
  frame.pixel_pitch_m = number({"XPIXSZ", "PIXSIZE1", "PIXSIZE"}, 0.1, 1000.0, 1e-6);
  frame.focal_length_m = number({"FOCALLEN"}, 1e-3, 1e9, 1e-3);
  frame.aperture_m = number({"APTDIA"}, 1e-3, 1e9, 1e-3);
  frame.gain_e_per_dn = number({"EGAIN"}, 1e-6, 1e6, 1.0);
  const auto camera = cards.first_text({"INSTRUME", "CAMERA", "DETECTOR", "TELESCOP"});
  frame.camera = camera ? camera->value : "";
  frame.filter = cards.text("FILTER");
  const auto pattern = cards.first_text({"BAYERPAT", "BAYERPTN", "COLORTYP"});
  frame.mosaic = pattern && pattern->value != "MONO";
}

/// The border that this program's own frames have without light.
void leave_out_reference_pixels(const StandardCards& cards, RawFrame& frame) {
  if (!cards.has("SIMT-BEG")) return;
  const int border = int(std::clamp(cards.number("REFPIX").value_or(0.0), 0.0, 1000.0));
  for (int y = 0; y < frame.rows && border > 0; ++y)
    for (int x = 0; x < frame.columns; ++x)
      if (x < border || y < border || x >= frame.columns - border || y >= frame.rows - border)
        frame.values[std::size_t(y) * std::size_t(frame.columns) + std::size_t(x)] = no_raw_value;
}

RawFrame raw_frame(FitsImage& image, int plane, const FitsValues& values, const std::string& name) {
  RawFrame frame{.columns = image.columns(), .rows = image.rows()};
  const StandardCards cards(values, frame.notes);
  for (const std::string& note : image.mended()) cards.assumed(note);
  std::vector<double> pixels;
  image.add_plane(plane, pixels);
  leave_out_overscan(cards, frame.columns, frame.rows, pixels);
  frame.values.reserve(pixels.size());
  std::size_t usable = 0;
  for (const double v : pixels) {
    const bool is_value = std::abs(v) <= largest_raw_value;
    usable += is_value;
    frame.values.push_back(is_value ? float(v) : no_raw_value);
  }
  set_facts_of(cards, frame);
  leave_out_reference_pixels(cards, frame);
  if (usable == 0) throw ConfigError(name + ": no pixel has a value");
  return frame;
}

}  // namespace

const char* name_of(FrameKind kind) {
  static constexpr std::array names{"unknown", "bias", "dark", "flat", "light"};
  return names[std::size_t(kind)];
}

FrameKind frame_kind_of(const std::string& text) {
  const std::string upper = upper_case(text);
  const auto has = [&](std::string_view word) { return upper.find(word) != std::string::npos; };
  // A flat's own dark ("dark flat", "flat dark") is a dark.
  if (has("BIAS") || has("ZERO") || has("OFFSET")) return FrameKind::bias;
  if (has("DARK")) return FrameKind::dark;
  if (has("FLAT") || has("LAMP") || has("TWILIGHT")) return FrameKind::flat;
  if (has("LIGHT") || has("OBJECT") || has("SCIENCE") || has("SKY")) return FrameKind::light;
  return FrameKind::unknown;
}

void read_raw_frames(const std::string& path, const FrameChoice& choice, const TakeRawFrame& take) {
  const std::string bytes = read_fits_file(path);
  FitsImage image(bytes, path);
  FitsValues values = image.values();
  for (const auto& [key, value] : choice.stated) values[key] = value;
  const int planes = image.planes();
  if (choice.plane && (*choice.plane < 1 || *choice.plane > planes))
    throw ConfigError(path + ": plane: must be in 1.." + std::to_string(planes) + ", got " +
                      std::to_string(*choice.plane));
  const int first = choice.plane.value_or(1), last = choice.plane.value_or(planes);
  for (int plane = first; plane <= last; ++plane)
    take(raw_frame(image, plane - 1, values, path), plane);
}

}  // namespace dmise
