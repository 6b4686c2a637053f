#include "nodes/gateway/preview_source.h"

#include <cstdio>

#include "core/base/error.h"
#include "core/base/files/text_file.h"

namespace dmise {

SharedPreview read_preview(const std::string& directory, const std::string& sensor,
                           std::uint32_t frame) {
  constexpr std::size_t max_bytes = std::size_t(64) << 20;
  if (directory.empty() || sensor.empty() || sensor.front() == '.' ||
      sensor.find('/') != std::string::npos)
    return nullptr;
  char name[32];
  std::snprintf(name, sizeof name, "/frame-%06u.png", unsigned(frame));
  try {
    std::string png = read_text_file(directory + "/" + sensor + name, max_bytes);
    if (!png.starts_with("\x89PNG")) return nullptr;
    return std::make_shared<const std::string>(std::move(png));
  } catch (const ConfigError&) {
    return nullptr;
  }
}

}  // namespace dmise
