#include "core/sequences/sequence_frame.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr double max_exposure_difference = 1e-3;  // relative

[[noreturn]] void refuse(const SequenceFrame& frame, const std::string& reason) {
  throw ConfigError(frame.name + ": " + reason);
}

void check_times(const SequenceFrame& frame) {
  const UnknownFacts& unknown = frame.header.unknown;
  if (unknown.has(FrameFact::exposure)) refuse(frame, "a frame of a sequence needs an EXPTIME");
  if (unknown.has(FrameFact::time) || frame.header.middle_utc.empty())
    refuse(frame, "a frame of a sequence needs a time (DATE-OBS)");
}

std::string size_of(const CountImage& image) {
  return std::to_string(image.columns) + " x " + std::to_string(image.rows) + " px";
}

/// Refuses a frame that is not of the first frame's camera.
void check_alike(const SequenceFrame& first, const SequenceFrame& frame) {
  const FrameHeader &a = first.header, &b = frame.header;
  if (frame.counts.columns != first.counts.columns || frame.counts.rows != first.counts.rows)
    refuse(frame, "frames of a sequence are of one size: " + size_of(frame.counts) + ", but " +
                      first.name + " has " + size_of(first.counts));
  if (a.sensor != b.sensor)
    refuse(frame, "frames of a sequence are of one sensor: \"" + b.sensor + "\", but " +
                      first.name + " is of \"" + a.sensor + "\"");
  if (std::abs(a.exposure_s - b.exposure_s) > max_exposure_difference * a.exposure_s)
    refuse(frame,
           formatted("frames of a sequence are exposed equally: %.6g s, but ", b.exposure_s) +
               first.name + formatted(" %.6g s", a.exposure_s));
}

}  // namespace

double seconds_between(const SequenceFrame& from, const SequenceFrame& to) {
  check_times(from);
  check_times(to);
  return Clock(parse_utc(from.header.middle_utc))
      .sim_time(parse_utc(to.header.middle_utc))
      .seconds();
}

void check_sequence(const std::vector<SequenceFrame>& frames) {
  if (frames.size() < min_sequence_frames || frames.size() > max_sequence_frames)
    throw ConfigError("--sequence: takes " + std::to_string(min_sequence_frames) + " to " +
                      std::to_string(max_sequence_frames) + " frames, got " +
                      std::to_string(frames.size()));
  for (const SequenceFrame& frame : frames) {
    check_alike(frames.front(), frame);
    check_times(frame);
    if (frame.header.shutter_closed()) refuse(frame, "the shutter was closed");
  }
  const CountImage& counts = frames.front().counts;
  const std::size_t pixels = counts.pixels.size() * frames.size();
  if (pixels > max_sequence_pixels)
    throw ConfigError("--sequence: takes at most " + std::to_string(max_sequence_pixels) +
                      " pixels in all frames together, got " + std::to_string(pixels));
}

void sort_by_time(std::vector<SequenceFrame>& frames) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < frames.size(); ++i)
    order.emplace_back(seconds_between(frames.front(), frames[i]), i);
  std::stable_sort(order.begin(), order.end());
  std::vector<SequenceFrame> sorted;
  for (std::size_t k = 0; k < order.size(); ++k) {
    SequenceFrame& frame = frames[order[k].second];
    if (k > 0 && !(order[k].first > order[k - 1].first))
      refuse(frame, "frames of a sequence have different times, but " + sorted.back().name +
                        " is of the same");
    sorted.push_back(std::move(frame));
  }
  frames = std::move(sorted);
}

}  // namespace dmise
