#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace dmise {

/// Where previews of frames come from. To take them from elsewhere, as from the wire, implement
/// this and name it in main.cpp. Called on the server's thread.
class PreviewSource {
 public:
  virtual ~PreviewSource() = default;
  /// A PNG of the frame without marks of any kind; empty if there is none (yet).
  virtual std::optional<std::string> preview(const std::string& sensor, std::uint32_t frame) = 0;
};

/// Previews in the directory of a run: SENSOR/frame-000001.png.
class DirectoryPreviews : public PreviewSource {
 public:
  static constexpr std::size_t max_bytes = std::size_t(64) << 20;

  explicit DirectoryPreviews(std::string directory) : directory_(std::move(directory)) {}
  std::optional<std::string> preview(const std::string& sensor, std::uint32_t frame) override;

 private:
  std::string directory_;
};

}  // namespace dmise
