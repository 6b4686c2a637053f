#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/ingest/any_frame.h"

namespace dmise {

/// What a frame was taken of, as cameras' headers say it.
enum class FrameKind { unknown, bias, dark, flat, light };

/// Name of a kind, as in notes and options.
const char* name_of(FrameKind kind);
/// Kind by the value of IMAGETYP, FRAME or OBSTYPE, in any case: "Bias Frame", "ZERO", "dome flat".
FrameKind frame_kind_of(const std::string& text);

/// A frame of any camera as its file has it: values are neither mapped nor evened.
struct RawFrame {
  int columns = 0, rows = 0;
  std::vector<float> values;  // rows x columns, NaN where there is none
  FrameKind kind = FrameKind::unknown;
  std::optional<double> exposure_s, temperature_c, pixel_pitch_m, focal_length_m, aperture_m,
      gain_e_per_dn;
  std::string camera, filter;
  bool mosaic = false;  // colours in one plane, every two columns and rows
  FrameNotes notes;
};

/// Receives the raw frames of a file, one after another, with their planes from 1.
using TakeRawFrame = std::function<void(RawFrame&&, int plane)>;

/// Reads a FITS file of any camera, also of this program, plane by plane, or the chosen plane.
/// Pixels of overscan and without light have no value. Throws `ConfigError` as `decode_frames`.
void read_raw_frames(const std::string& path, const FrameChoice& choice, const TakeRawFrame& take);

}  // namespace dmise
