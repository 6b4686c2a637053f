#include "core/camera_calibration/detector/calibration_set.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/ingest/count_map.h"

namespace dmise {
namespace {

constexpr int min_side_px = 64;
constexpr double longest_bias_s = 1e-3;
constexpr double min_star_share = 3e-5;  // pixels that are bright beside a bright one, over all

/// The share of pixels that are far above the level and have a bright neighbour, as in stars; hot
/// pixels have none.
double star_share_of(const std::vector<float>& values, int columns, double level, double noise) {
  const double high = level + 8 * noise, beside = level + 4 * noise;
  std::size_t bright = 0;
  for (std::size_t i = 1; i < values.size(); ++i)
    bright +=
        i % std::size_t(columns) > 0 && double(values[i]) > high && double(values[i - 1]) > beside;
  return double(bright) / double(values.size());
}

/// The values with the kinds of a mosaic's pixels apart.
std::vector<float> apart(const std::vector<float>& values, int columns, int rows) {
  std::vector<float> out(values.size());
  const int half_x = (columns + 1) / 2, half_y = (rows + 1) / 2;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const int to_x = x / 2 + x % 2 * half_x, to_y = y / 2 + y % 2 * half_y;
      out[std::size_t(to_y) * std::size_t(columns) + std::size_t(to_x)] =
          values[std::size_t(y) * std::size_t(columns) + std::size_t(x)];
    }
  return out;
}

}  // namespace

std::string CalibrationFrame::name() const {
  return plane == 1 ? path : path + " plane " + std::to_string(plane);
}

CalibrationSet::CalibrationSet(const std::vector<CalibrationFile>& files, const FrameChoice& choice)
    : choice_(choice) {
  if (files.empty()) throw ConfigError("frames: there are none");
  for (const CalibrationFile& file : files) read(file);
  if (!(step_ > 0)) step_ = 1.0;
  if (step_ > 1)
    notes_.push_back(formatted("counts are multiples of %.0f: they are divided by it", step_));
  if (!whole_)
    notes_.push_back(
        "counts are no whole numbers: frames that were averaged or scaled have less noise than "
        "the camera");
  for (auto* list : {&unsorted_, &frames_[1], &frames_[2], &frames_[3], &frames_[4]})
    for (CalibrationFrame& frame : *list) {
      for (double* dn : {&frame.level, &frame.greatest}) *dn = (*dn - zero_) / step_;
      frame.noise /= step_;
    }
  sort();
  tiles_.emplace(columns_, rows_, mosaic_ ? (columns_ + 1) / 2 : 0, mosaic_ ? (rows_ + 1) / 2 : 0);
}

void CalibrationSet::read(const CalibrationFile& file) {
  read_raw_frames(file.path, choice_, [&](RawFrame&& raw, int plane) {
    CalibrationFrame frame{.path = file.path, .plane = plane};
    if (columns_ == 0) {
      columns_ = raw.columns;
      rows_ = raw.rows;
      if (std::min(columns_, rows_) < min_side_px)
        throw ConfigError(formatted("%s: NAXIS1: must be at least %d by %d pixels, got %d by %d",
                                    file.path.c_str(), min_side_px, min_side_px, columns_, rows_));
    }
    if (raw.columns != columns_ || raw.rows != rows_)
      throw ConfigError(
          formatted("%s: NAXIS1: must be %d by %d as of the first frame, got %d by %d",
                    file.path.c_str(), columns_, rows_, raw.columns, raw.rows));
    frame.kind = file.kind != FrameKind::unknown ? file.kind : raw.kind;
    frame.exposure_s = raw.exposure_s;
    frame.temperature_c = raw.temperature_c;
    std::vector<double> values(raw.values.begin(), raw.values.end());
    frame.level = robust_level(raw.values).level;
    frame.noise = pixel_noise(values, columns_);
    bool whole = true;
    for (const double v : values) {
      if (!std::isfinite(v)) continue;
      if (v > frame.greatest) frame.greatest = v, frame.greatest_pixels = 0;
      frame.greatest_pixels += v == frame.greatest;
      whole = whole && v == std::floor(v) && v >= 0 && v <= 65535;
    }
    whole_ = whole_ && whole;
    const CountMap map = whole ? common_step(values) : CountMap{};
    // A frame without noise, as a saturated one, tells no step.
    if (!whole || frame.noise > 0) {
      const bool agrees = step_ == 0 || map.zero == zero_;
      step_ = agrees ? double(std::gcd(long(step_), long(map.step))) : 1.0;
      zero_ = step_ > 1 ? map.zero : 0.0;
    }
    mosaic_ = mosaic_ || raw.mosaic;
    take_facts(raw);
    if (frame.kind == FrameKind::unknown) {
      unsorted_.push_back(frame);
      star_shares_.push_back(star_share_of(raw.values, columns_, frame.level, frame.noise));
    } else {
      frames_[std::size_t(frame.kind)].push_back(frame);
    }
  });
}

void CalibrationSet::take_facts(const RawFrame& frame) {
  const auto take = [](auto& to, const auto& from) {
    if (!to) to = from;
  };
  take(facts_.pixel_pitch_m, frame.pixel_pitch_m);
  take(facts_.focal_length_m, frame.focal_length_m);
  take(facts_.aperture_m, frame.aperture_m);
  take(facts_.gain_e_per_dn, frame.gain_e_per_dn);
  if (facts_.camera.empty()) facts_.camera = frame.camera;
  if (facts_.filter.empty()) facts_.filter = frame.filter;
}

FrameKind CalibrationSet::guess(const CalibrationFrame& frame, double dark_level) const {
  const auto at = std::size_t(&frame - unsorted_.data());
  if (frame.exposure_s && *frame.exposure_s <= longest_bias_s) return FrameKind::bias;
  if (star_shares_[at] > min_star_share) return FrameKind::light;
  if (frame.level - dark_level > 10 * std::max(frame.noise, 1.0)) return FrameKind::flat;
  return frame.exposure_s ? FrameKind::dark : FrameKind::bias;
}

void CalibrationSet::sort() {
  double dark_level = HUGE_VAL;
  for (const auto* list : {&unsorted_, &frames_[1], &frames_[2]})
    for (const CalibrationFrame& frame : *list) dark_level = std::min(dark_level, frame.level);
  for (CalibrationFrame& frame : unsorted_) {
    frame.kind = guess(frame, dark_level);
    frames_[std::size_t(frame.kind)].push_back(frame);
    notes_.push_back(frame.name() + ": no IMAGETYP: taken for a " + name_of(frame.kind) +
                     " by its exposure, level and stars");
  }
  for (auto& frames : frames_)
    std::ranges::stable_sort(frames, {}, [](const CalibrationFrame& f) {
      return std::pair(f.exposure_s.value_or(0.0), f.level);
    });
}

std::vector<float> CalibrationSet::values(const CalibrationFrame& frame) const {
  FrameChoice choice = choice_;
  choice.plane = frame.plane;
  std::vector<float> out;
  read_raw_frames(frame.path, choice, [&](RawFrame&& raw, int) { out = std::move(raw.values); });
  if (out.size() != std::size_t(columns_) * std::size_t(rows_))
    throw Error(frame.path + ": has changed since it was read");
  if (step_ != 1 || zero_ != 0)
    for (float& v : out) v = float((double(v) - zero_) / step_);
  return mosaic_ ? apart(out, columns_, rows_) : out;
}

}  // namespace dmise
