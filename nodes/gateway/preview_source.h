#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace dmise {

/// A PNG of a frame without annotations; null if there is none.
using SharedPreview = std::shared_ptr<const std::string>;

/// Where previews of frames come from.
class PreviewSource {
 public:
  using Answer = std::function<void(SharedPreview)>;

  virtual ~PreviewSource() = default;
  /// Calls `answer` once, within seconds, from any thread. Returns at once.
  virtual void request(const std::string& sensor, std::uint32_t frame, Answer answer) = 0;
};

/// Reads the preview SENSOR/frame-000001.png in the directory of a run; null if there is none, or
/// if `directory` is empty.
SharedPreview read_preview(const std::string& directory, const std::string& sensor,
                           std::uint32_t frame);

}  // namespace dmise
