#include "nodes/gateway/static_files.h"

#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include "core/base/error.h"
#include "core/base/files/digest.h"

namespace dmise {
namespace {

constexpr std::size_t fewest_bytes_to_gzip = 1024;
constexpr int gzip_format = 15 + 16;  // zlib: the largest window, with the header of gzip

std::string gzip(const std::string& bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, 6, Z_DEFLATED, gzip_format, 8, Z_DEFAULT_STRATEGY) != Z_OK) return {};
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = uInt(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = uInt(out.size());
  const bool ended = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return ended ? out : std::string();
}

}  // namespace

const std::string& StaticFile::gzipped() const {
  if (gzipped_) return *gzipped_;
  gzipped_.emplace();
  const bool compressed = type == "image/png" || type == "image/jpeg";
  if (!compressed && content.size() >= fewest_bytes_to_gzip) gzipped_ = gzip(content);
  if (gzipped_->size() >= content.size()) gzipped_->clear();
  return *gzipped_;
}

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
      const std::string digest = sha256_hex(file->content).substr(0, 32);
      file->etag = '"' + digest + '"';
      file->gzipped_etag = '"' + digest + "-gzip\"";
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
