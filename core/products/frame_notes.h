#pragma once
#include <string>
#include <vector>

namespace dmise {

/// What a frame's header leaves unsaid, as short texts: facts that stay unknown, and those that are
/// taken from elsewhere (a convention, or a measurement in the frame itself).
struct FrameNotes {
  std::vector<std::string> missing, assumed;

  bool operator==(const FrameNotes&) const = default;
};

}  // namespace dmise
