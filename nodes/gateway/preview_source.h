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

/// Previews in the directory of a run: SENSOR/frame-000001.png.
class PreviewDirectory {
 public:
  static constexpr std::size_t max_bytes = std::size_t(64) << 20;

  /// `directory`: empty if there is none.
  explicit PreviewDirectory(std::string directory) : directory_(std::move(directory)) {}
  SharedPreview find(const std::string& sensor, std::uint32_t frame) const;

 private:
  std::string directory_;
};

}  // namespace dmise
