#include "sensors/observatory/camera_control.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

constexpr double cooling_time_s = 30.0;
constexpr double min_goal_c = -100.0, max_goal_c = 50.0;
constexpr double max_cooling_k = 60.0;  // below the ambient temperature, at full power

[[noreturn]] void refuse(DeviceFault fault, const std::string& reason) {
  throw DeviceError(fault, reason);
}

}  // namespace

CameraControl::CameraControl(const CameraSettings& settings)
    : settings_(settings),
      goal_c_(settings.camera.detector.temperature_c),
      from_c_(settings.camera.detector.temperature_c) {
  window_.columns = settings_.camera.optics.columns;
  window_.rows = settings_.camera.optics.rows;
}

int CameraControl::max_adu() const { return (1 << settings_.camera.detector.adc_bits) - 1; }

void CameraControl::set_bin(int bin) {
  if (bin < 1 || bin > max_bin)
    refuse(DeviceFault::invalid_value, "binning must be 1 to " + std::to_string(max_bin));
  const Optics& optics = settings_.camera.optics;
  const bool whole = window_.x == 0 && window_.y == 0 &&
                     window_.columns == optics.columns / window_.bin_x &&
                     window_.rows == optics.rows / window_.bin_y;
  window_.bin_x = window_.bin_y = bin;
  if (!whole) return;
  window_.columns = optics.columns / bin;
  window_.rows = optics.rows / bin;
}

void CameraControl::set_start(std::optional<int> x, std::optional<int> y) {
  window_.x = x.value_or(window_.x);
  window_.y = y.value_or(window_.y);
}

void CameraControl::set_size(std::optional<int> columns, std::optional<int> rows) {
  window_.columns = columns.value_or(window_.columns);
  window_.rows = rows.value_or(window_.rows);
}

bool CameraControl::has_cooler() const { return settings_.camera.detector.dark_doubling_k > 0.0; }

void CameraControl::need_cooler() const {
  if (!has_cooler())
    refuse(DeviceFault::not_implemented,
           "the camera file gives no detector.dark_doubling_k: its temperature changes nothing");
}

double CameraControl::temperature_c(SimTime now) const {
  if (!has_cooler()) return settings_.camera.detector.temperature_c;
  const double t_s = std::max(0.0, (now - from_).seconds());
  return goal_now_c() + (from_c_ - goal_now_c()) * std::exp(-t_s / cooling_time_s);
}

double CameraControl::cooler_power_percent(SimTime now) const {
  if (!cooler_on_) return 0.0;
  return std::clamp(100.0 * (settings_.ambient_c - temperature_c(now)) / max_cooling_k, 0.0, 100.0);
}

void CameraControl::set_goal_c(double goal_c, SimTime now) {
  need_cooler();
  if (!(goal_c >= min_goal_c && goal_c <= max_goal_c))
    refuse(DeviceFault::invalid_value, "the temperature must be -100 to 50 C");
  from_c_ = temperature_c(now);
  from_ = now;
  goal_c_ = goal_c;
}

void CameraControl::set_cooler(bool on, SimTime now) {
  need_cooler();
  from_c_ = temperature_c(now);
  from_ = now;
  cooler_on_ = on;
}

void CameraControl::need_idle(SimTime now) const {
  switch (state(now)) {
    case CameraState::idle:
      return;
    case CameraState::error:
      refuse(DeviceFault::driver, failure_);
    default:
      refuse(DeviceFault::invalid_operation, "an exposure is under way");
  }
}

CommandedExposure CameraControl::planned(double exposure_s, SimTime now) const {
  need_idle(now);
  if (!(exposure_s >= min_commanded_exposure_s && exposure_s <= max_commanded_exposure_s))
    refuse(DeviceFault::invalid_value, "Duration must be 0.001 to 3600 s");
  const Optics& optics = settings_.camera.optics;
  const auto check = [](const char* key, int value, int low, int high) {
    if (value < low || value > high)
      refuse(DeviceFault::invalid_value, std::string(key) + " must be " + std::to_string(low) +
                                             " to " + std::to_string(high) + ", is " +
                                             std::to_string(value));
  };
  const int columns = optics.columns / window_.bin_x, rows = optics.rows / window_.bin_y;
  check("StartX", window_.x, 0, columns - 1);
  check("StartY", window_.y, 0, rows - 1);
  check("NumX", window_.columns, 1, columns - window_.x);
  check("NumY", window_.rows, 1, rows - window_.y);
  return {.start = now,
          .length = sim_seconds(exposure_s),
          .pointing = {},
          .window = window_,
          .temperature_c = temperature_c(now)};
}

void CameraControl::open(const CommandedExposure& exposure) {
  image_.reset();
  open_ = exposure;
}

std::optional<SimTime> CameraControl::stop(SimTime now) {
  if (!open_ || state(now) != CameraState::exposing) return std::nullopt;
  open_->length = std::max(now - open_->start, sim_seconds(min_commanded_exposure_s));
  return open_->length;
}

bool CameraControl::abort(SimTime now) {
  if (!open_) return false;
  if (state(now) == CameraState::reading)
    refuse(DeviceFault::invalid_operation, "the exposure has ended and is being read");
  open_.reset();
  return true;
}

void CameraControl::deliver(const CountImage& frame, const std::string& start_utc,
                            const FrameHeader& header) {
  if (!open_) return;
  image_ = std::make_shared<const TakenImage>(
      TakenImage{window_of(frame, open_->window, max_adu()), open_->window, header});
  last_exposure_s_ = open_->length.seconds();
  last_start_utc_ = start_utc;
  open_.reset();
}

void CameraControl::fail(const std::string& reason) {
  failure_ = reason;
  open_.reset();
}

CameraState CameraControl::state(SimTime now) const {
  if (!failure_.empty()) return CameraState::error;
  if (!open_) return CameraState::idle;
  return now < open_->start + open_->length ? CameraState::exposing : CameraState::reading;
}

std::shared_ptr<const CountImage> CameraControl::image() const {
  if (!failure_.empty()) refuse(DeviceFault::driver, failure_);
  if (!image_) refuse(DeviceFault::invalid_operation, "there is no image");
  return {image_, &image_->counts};
}

int CameraControl::percent_completed(SimTime now) const {
  switch (state(now)) {
    case CameraState::exposing:
      return int(100.0 * (now - open_->start).seconds() / open_->length.seconds());
    case CameraState::reading:
      return 100;
    case CameraState::idle:
      return image_ ? 100 : 0;
    case CameraState::error:
      break;
  }
  refuse(DeviceFault::driver, failure_);
}

double CameraControl::left_s(SimTime now) const {
  return open_ ? std::max(0.0, (open_->start + open_->length - now).seconds()) : 0.0;
}

double CameraControl::last_exposure_s() const {
  if (!last_exposure_s_) refuse(DeviceFault::invalid_operation, "there was no exposure");
  return *last_exposure_s_;
}

const std::string& CameraControl::last_start_utc() const {
  if (!last_exposure_s_) refuse(DeviceFault::invalid_operation, "there was no exposure");
  return last_start_utc_;
}

CountImage window_of(const CountImage& frame, const Window& w, int max_count) {
  CountImage part(w.columns, w.rows);
  for (int y = 0; y < w.rows; ++y) {
    std::uint16_t* row = part.row(y);
    if (w.bin_x == 1 && w.bin_y == 1) {
      std::copy_n(frame.row(w.y + y) + w.x, w.columns, row);
      continue;
    }
    for (int x = 0; x < w.columns; ++x) {
      int sum = 0;
      for (int j = 0; j < w.bin_y; ++j)
        for (int i = 0; i < w.bin_x; ++i)
          sum += frame.at((w.x + x) * w.bin_x + i, (w.y + y) * w.bin_y + j);
      row[x] = std::uint16_t(std::min(sum, max_count));
    }
  }
  return part;
}

}  // namespace dmise
