#pragma once
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/products/frame_header.h"
#include "core/products/pixel_mask.h"

namespace dmise {

/// A frame of a sequence: exposures of one sensor, of one length, that see one field.
struct SequenceFrame {
  std::string name;  // file name, for messages
  CountImage counts;
  FrameHeader header;       // solved, where its stars were solved
  PixelMask unusable = {};  // pixels without a value; empty: all have one
};

inline constexpr std::size_t min_sequence_frames = 3;
inline constexpr std::size_t max_sequence_frames = 200;
/// Pixels of all frames together, which bounds the memory: 19 bytes each.
inline constexpr std::size_t max_sequence_pixels = 200'000'000;

/// Middle of an exposure [s], since that of another frame, by both frames' UTC. Throws
/// `ConfigError` "NAME: reason" where the header lacks the time or the length of the exposure.
double seconds_between(const SequenceFrame& from, const SequenceFrame& to);

/// Throws `ConfigError` "NAME: reason" for frames that are no sequence: too few or too many, of
/// different sizes, sensors or exposures, of unknown or equal times, or with a closed shutter.
void check_sequence(const std::vector<SequenceFrame>& frames);

/// Brings frames into the order of their times.
void sort_by_time(std::vector<SequenceFrame>& frames);

}  // namespace dmise
