#pragma once
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "nodes/gateway/preview_source.h"

namespace dmise {

/// Draws the counts of a FITS file: a grey PNG, at most 1024 pixels wide. Throws `ConfigError` for
/// what is no frame.
std::string draw_preview(std::string_view fits);

/// Previews drawn of the frames that sensors serve while they run (docs/wire.md, Frames), of those
/// alone that somebody asks for; the last 32 MiB are kept. A frame that its sensor does not serve
/// is looked for in the run's directory. Works on a thread of its own.
class FramePreviews : public PreviewSource {
 public:
  /// `keys`, `name`: as in `RunObserverOptions`. Throws `ConfigError` for keys that cannot be used.
  FramePreviews(const std::string& keys, const std::string& name, PreviewDirectory directory);
  ~FramePreviews() override;
  FramePreviews(const FramePreviews&) = delete;
  FramePreviews& operator=(const FramePreviews&) = delete;

  /// Frame endpoints by sensor, of a run; none: the run is over. From any thread.
  void follow(std::uint64_t run_id, std::map<std::string, std::string> endpoints);
  void request(const std::string& sensor, std::uint32_t frame, Answer answer) override;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace dmise
