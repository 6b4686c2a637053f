#include "core/sky/stars/shared_star_map.h"

#include <mutex>
#include <utility>
#include <vector>

#include "core/base/files/file_version.h"
#include "core/sky/stars/star_cache.h"

namespace dmise {
namespace {

constexpr std::size_t kept_maps = 2;

/// The maps of this process. The lock is not held while a map is loaded, so that a process that is
/// forked meanwhile can load.
class SharedMaps {
 public:
  std::shared_ptr<const StarMap> find(const FileVersion& version) {
    std::lock_guard lock(mutex_);
    for (const Entry& entry : entries_)
      if (entry.version == version)
        if (auto map = entry.map.lock()) return use(std::move(map));
    return nullptr;
  }

  void add(FileVersion version, std::shared_ptr<const StarMap> map) {
    std::lock_guard lock(mutex_);
    std::erase_if(entries_, [](const Entry& entry) { return entry.map.expired(); });
    entries_.push_back({std::move(version), map});
    use(std::move(map));
  }

 private:
  struct Entry {
    FileVersion version;
    std::weak_ptr<const StarMap> map;
  };

  std::shared_ptr<const StarMap> use(std::shared_ptr<const StarMap> map) {
    std::erase(kept_, map);
    kept_.push_back(map);
    if (kept_.size() > kept_maps) kept_.erase(kept_.begin());
    return map;
  }

  std::mutex mutex_;
  std::vector<Entry> entries_;
  std::vector<std::shared_ptr<const StarMap>> kept_;  // the one used last at the end
};

SharedMaps& shared_maps() {
  static auto* const maps = new SharedMaps;  // threads may use it until the process ends
  return *maps;
}

}  // namespace

std::shared_ptr<const StarMap> share_star_map(const std::string& path,
                                              const std::string& cache_dir) {
  const auto version = file_version(path);
  if (version)
    if (auto map = shared_maps().find(*version)) return map;
  auto map = std::make_shared<const StarMap>(load_star_map(path, cache_dir));
  if (version && file_version(path) == version) shared_maps().add(*version, map);
  return map;
}

}  // namespace dmise
