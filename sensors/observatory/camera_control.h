#pragma once
#include <memory>
#include <optional>
#include <string>

#include "core/base/image.h"
#include "core/config/scenario.h"
#include "sensors/observatory/commanded_exposure.h"
#include "sensors/observatory/device_error.h"
#include "sensors/observatory/taken_image.h"

namespace dmise {

/// Numbers are those of ASCOM's CameraStates.
enum class CameraState { idle = 0, exposing = 2, reading = 3, error = 5 };

struct CameraSettings {
  Camera camera;
  double readout_s = 0.1;  // between the end of an exposure and its image, >= 0
  double ambient_c = 10.0;
};

/// A camera as its commands set it: a state machine over the time that each call is given, which
/// must not decrease. It hands out exposures; `deliver` brings back their images. Calls throw
/// `DeviceError`.
class CameraControl {
 public:
  explicit CameraControl(const CameraSettings& settings);

  const Camera& camera() const { return settings_.camera; }
  int max_adu() const;
  double readout_s() const { return settings_.readout_s; }

  /// What the next exposure takes; it is checked when that starts.
  const Window& window() const { return window_; }
  /// [1, max_bin], the same along both axes; the window becomes the whole frame if it was.
  void set_bin(int bin);
  void set_start(std::optional<int> x, std::optional<int> y);
  void set_size(std::optional<int> columns, std::optional<int> rows);

  // Temperature of the detector, which matters if its dark current depends on it: it approaches
  // its goal exponentially.
  bool has_cooler() const;
  /// Refuses what a camera without one cannot do.
  void need_cooler() const;
  double temperature_c(SimTime now) const;
  double ambient_c() const { return settings_.ambient_c; }
  double goal_c() const { return goal_c_; }
  bool cooler_on() const { return cooler_on_; }
  double cooler_power_percent(SimTime now) const;
  void set_goal_c(double goal_c, SimTime now);
  void set_cooler(bool on, SimTime now);

  /// Returns the exposure that would begin now, without sensor, frame and pointing. Refuses one
  /// that the camera cannot take.
  CommandedExposure planned(double exposure_s, SimTime now) const;
  /// Opens the shutter.
  void open(const CommandedExposure& exposure);
  /// Ends the exposure now: its image comes after the readout. Returns its new length, if one was
  /// under way.
  std::optional<SimTime> stop(SimTime now);
  /// Ends the exposure without an image; returns whether there was one.
  bool abort(SimTime now);
  /// The image of the exposure under way is there, whole. `header`: of its file.
  void deliver(const CountImage& frame, const std::string& start_utc,
               const FrameHeader& header = {});
  /// The frame of the exposure under way could not be made or written: no more are taken.
  void fail(const std::string& reason);

  CameraState state(SimTime now) const;
  bool image_ready() const { return image_ != nullptr; }
  /// Columns x rows of the window; refused if there is none.
  std::shared_ptr<const CountImage> image() const;
  /// The image with what a file of it takes; null if there is none.
  std::shared_ptr<const TakenImage> taken() const { return image_; }
  int percent_completed(SimTime now) const;
  /// Until the shutter closes; 0 if it is closed.
  double left_s(SimTime now) const;
  /// The length of the last exposure that has an image; refused before the first.
  double last_exposure_s() const;
  const std::string& last_start_utc() const;

 private:
  void need_idle(SimTime now) const;
  double goal_now_c() const { return cooler_on_ ? goal_c_ : settings_.ambient_c; }

  CameraSettings settings_;
  Window window_;
  double goal_c_, from_c_;
  SimTime from_;  // when it had `from_c_`
  bool cooler_on_ = true;
  std::optional<CommandedExposure> open_;  // until its image is there
  std::shared_ptr<const TakenImage> image_;
  std::optional<double> last_exposure_s_;
  std::string last_start_utc_, failure_;
};

/// Returns the window of a frame: sums of its bins' counts, which saturate at `max_count`.
CountImage window_of(const CountImage& frame, const Window& window, int max_count);

}  // namespace dmise
