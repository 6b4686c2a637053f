#pragma once
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "nodes/gateway/preview_source.h"

namespace dmise {

/// Returns a grey PNG of the counts of a FITS file, at most 1024 pixels wide. Throws `ConfigError`
/// if it is not a frame.
std::string draw_preview(std::string_view fits);

/// Draws previews, when they are requested, of frames that sensors serve while they run
/// (docs/wire.md, Frames), and keeps the last 32 MiB. The preview of a frame that its sensor does
/// not serve is read from the run's directory. Has a thread of its own.
class FramePreviews : public PreviewSource {
 public:
  /// `keys`, `name`: as in `RunObserverOptions`. `directory`: of the run; may be empty. Throws
  /// `ConfigError` for keys that cannot be used.
  FramePreviews(const std::string& keys, const std::string& name, std::string directory);
  ~FramePreviews() override;
  FramePreviews(const FramePreviews&) = delete;
  FramePreviews& operator=(const FramePreviews&) = delete;

  /// Sets the frame endpoints of a run, by sensor; none: the run is over. From any thread.
  void follow(std::uint64_t run_id, std::map<std::string, std::string> endpoints);
  void request(const std::string& sensor, std::uint32_t frame, Answer answer) override;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace dmise
