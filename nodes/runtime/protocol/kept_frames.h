#pragma once
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "core/sim/message.h"
#include "dmise/v1/frame.pb.h"

namespace dmise {

/// The bytes of a FITS file, in memory or mapped.
struct FrameBytes {
  std::shared_ptr<const void> owner;
  std::string_view bytes;
};

/// The last frames of a sensor, for readers that request their pixels. The sensor's thread adds
/// frames and another thread answers, so that the sensor never waits for a reader.
class KeptFrames {
 public:
  static constexpr std::size_t max_frames = 128;
  static constexpr std::size_t max_bytes = std::size_t(64) << 20;  // in memory; one frame at least

  explicit KeptFrames(std::string sensor) : sensor_(std::move(sensor)) {}
  /// `changed` is called when a frame is added and by `end`, from the thread that does it.
  void when_changed(std::function<void()> changed);

  /// Adds a frame, later than all before. `load` returns its file when it is requested, or throws
  /// `Error`; empty: the frame is only counted. `held_bytes`: memory that `load` holds.
  void add(const FrameReport& report, std::function<FrameBytes()> load, std::size_t held_bytes = 0);
  /// No more frames are added.
  void end();

  /// Whether readers are connected. Frames that are not in files need to be kept only then.
  bool wanted() const { return wanted_; }
  void set_wanted(bool wanted) { wanted_ = wanted; }

  struct Answer {
    v1::FrameAnswer head;
    FrameBytes fits;  // empty unless STATUS_SENT
  };
  /// Returns nothing while the requested frame is yet to come. `run_id` goes into the answer.
  std::optional<Answer> answer(const v1::FrameRequest& request, std::uint64_t run_id) const;

 private:
  struct Kept {
    std::uint32_t number = 0;
    std::uint64_t sequence = 0;
    std::string report;  // serialised
    std::function<FrameBytes()> load;
    std::size_t held_bytes = 0;
  };
  const Kept* wanted_by(const v1::FrameRequest& request) const;

  std::string sensor_;
  std::atomic<bool> wanted_{false};
  mutable std::mutex mutex_;  // guards what follows
  std::deque<Kept> kept_;
  std::size_t held_bytes_ = 0;
  std::uint64_t made_ = 0;
  bool over_ = false;
  std::function<void()> changed_ = [] {};
};

}  // namespace dmise
