#include "launch/run/file_digest.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/files/digest.h"
#include "core/base/files/file_version.h"
#include "core/base/files/text_file.h"
#include "core/sky/stars/star_map_file.h"

namespace dmise {
namespace {

/// The digests of the files that this process read last. The lock is not held while one is read,
/// so that a process that is forked meanwhile can read.
class FileDigests {
 public:
  std::optional<std::string> find(const FileVersion& version) {
    std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(entries_, version, &Entry::version);
    return found == entries_.end() ? std::nullopt : std::optional(found->digest);
  }

  void add(FileVersion version, std::string digest) {
    std::lock_guard lock(mutex_);
    std::erase_if(entries_, [&](const Entry& entry) { return entry.version.path == version.path; });
    if (entries_.size() == max_entries) entries_.erase(entries_.begin());
    entries_.push_back({std::move(version), std::move(digest)});
  }

 private:
  static constexpr std::size_t max_entries = 64;
  struct Entry {
    FileVersion version;
    std::string digest;
  };

  std::mutex mutex_;
  std::vector<Entry> entries_;
};

FileDigests& known_digests() {
  static auto* const digests = new FileDigests;  // threads may use it until the process ends
  return *digests;
}

}  // namespace

std::string file_digest(const std::string& path) {
  const auto version = file_version(path);
  if (version)
    if (auto known = known_digests().find(*version)) return std::move(*known);
  std::string digest =
      sha256_hex(is_star_map_file(path) ? star_map_fingerprint(path) : read_text_file(path));
  if (version && file_version(path) == version) known_digests().add(*version, digest);
  return digest;
}

}  // namespace dmise
