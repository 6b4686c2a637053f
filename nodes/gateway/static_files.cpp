#include "nodes/gateway/static_files.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include "core/base/digest.h"
#include "core/base/error.h"

namespace dmise {

const char* media_type(const std::string& path) {
  static constexpr std::pair<std::string_view, const char*> types[] = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".jpeg", "image/jpeg"},
      {".xml", "application/xml"},
      {".wasm", "application/wasm"},
      {".txt", "text/plain; charset=utf-8"},
      {".ico", "image/x-icon"}};
  for (const auto& [ending, type] : types)
    if (std::string_view(path).ends_with(ending)) return type;
  return "application/octet-stream";
}

StaticFiles::StaticFiles(const std::string& directory) {
  namespace fs = std::filesystem;
  if (directory.empty() || !fs::is_directory(directory)) return;
  std::size_t bytes = 0;
  try {
    for (const auto& entry : fs::recursive_directory_iterator(directory)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream in(entry.path(), std::ios::binary);
      std::ostringstream content;
      content << in.rdbuf();
      if (!in) throw ConfigError(entry.path().string() + ": cannot be read");
      const std::string path = fs::relative(entry.path(), directory).generic_string();
      auto file = std::make_shared<StaticFile>();
      file->content = std::move(content).str();
      file->type = media_type(path);
      file->etag = '"' + sha256_hex(file->content).substr(0, 32) + '"';
      bytes += file->content.size();
      files_[path] = std::move(file);
      if (bytes > max_bytes || files_.size() > max_files)
        throw ConfigError(directory + ": has more or larger files than a dashboard");
    }
  } catch (const fs::filesystem_error& error) {
    throw ConfigError(directory + ": " + error.code().message());
  }
}

std::shared_ptr<const StaticFile> StaticFiles::find(const std::string& path) const {
  const auto file = files_.find(path);
  return file == files_.end() ? nullptr : file->second;
}

}  // namespace dmise
