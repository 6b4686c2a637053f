#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace dmise {

struct StaticFile {
  std::string content, type, etag;
  std::string gzipped_etag;

  /// The content as gzip (RFC 1952); "" if that is not worth it. Compressed when first asked for:
  /// use it from one thread.
  const std::string& gzipped() const;

 private:
  mutable std::optional<std::string> gzipped_;
};

/// The files of the dashboard, read once, so that no request can name another file.
class StaticFiles {
 public:
  static constexpr std::size_t max_bytes = std::size_t(128) << 20, max_files = 5000;

  /// Reads all files below `directory`; a directory that does not exist has none. Throws
  /// `ConfigError` if one cannot be read, or they exceed the limits.
  explicit StaticFiles(const std::string& directory);

  bool empty() const { return files_.empty(); }
  /// Null if there is no such file.
  std::shared_ptr<const StaticFile> find(const std::string& path) const;

 private:
  std::map<std::string, std::shared_ptr<const StaticFile>> files_;
};

/// Media type by the ending of a name.
const char* media_type(const std::string& path);

}  // namespace dmise
