#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/camera_calibration/detector/tiles.h"
#include "core/ingest/raw_frame.h"

namespace dmise {

/// A file of a camera's frames, and of what the user says that it is.
struct CalibrationFile {
  std::string path;
  FrameKind kind = FrameKind::unknown;
};

/// A frame of the set without its pixels.
struct CalibrationFrame {
  std::string path;
  int plane = 1;
  FrameKind kind = FrameKind::unknown;
  std::optional<double> exposure_s, temperature_c;
  double level = 0.0, noise = 0.0;  // pixels' median, and noise from pixel to pixel [DN]
  double greatest = 0.0;            // value of a pixel
  std::size_t greatest_pixels = 0;  // that have it

  std::string name() const;  // the path, and the plane of a cube
};

/// What all headers of a set say alike.
struct CameraFacts {
  std::string camera, filter;
  std::optional<double> pixel_pitch_m, focal_length_m, aperture_m, gain_e_per_dn;
};

/// All frames of one camera, sorted by what they are. Only one is in memory at a time.
class CalibrationSet {
 public:
  /// Reads every frame once. A kind is that of the user, else of the header, else by exposure,
  /// level and stars, which is noted. Counts that were padded (as 12 bits to 16) are divided by
  /// their common step. Throws `ConfigError` for no frames, or of different sizes.
  CalibrationSet(const std::vector<CalibrationFile>& files, const FrameChoice& choice);

  /// Frames of a kind by rising exposure, then level, then as given.
  const std::vector<CalibrationFrame>& of(FrameKind kind) const {
    return frames_[std::size_t(kind)];
  }
  /// Values of a frame [DN], NaN where there are none. The kinds of a mosaic's pixels lie apart:
  /// even columns are before odd ones, even rows before odd ones.
  std::vector<float> values(const CalibrationFrame& frame) const;

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  bool is_mosaic() const { return mosaic_; }
  /// Whether counts are whole numbers, whose rounding has a variance of 1/12.
  bool is_whole() const { return whole_; }
  double step() const { return step_; }  // that counts were divided by
  double zero() const { return zero_; }  // and what was taken off before
  const Tiles& tiles() const { return *tiles_; }
  const CameraFacts& facts() const { return facts_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void read(const CalibrationFile& file);
  void sort();
  FrameKind guess(const CalibrationFrame& frame, double dark_level) const;
  void take_facts(const RawFrame& frame);

  FrameChoice choice_;
  std::vector<CalibrationFrame> frames_[5];
  std::vector<CalibrationFrame> unsorted_;
  std::vector<double> star_shares_;  // one for each unsorted frame
  int columns_ = 0, rows_ = 0;
  bool mosaic_ = false, whole_ = true;
  double step_ = 0.0, zero_ = 0.0;  // common to all; 0: not known yet
  std::optional<Tiles> tiles_;
  CameraFacts facts_;
  std::vector<std::string> notes_;
};

}  // namespace dmise
