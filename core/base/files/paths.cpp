#include "core/base/files/paths.h"

#include <filesystem>

#include "core/base/error.h"

namespace dmise {

bool path_exists(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

void make_directories(const std::string& path, const char* option) {
  std::error_code failure;
  std::filesystem::create_directories(path, failure);
  if (!failure) return;
  const std::string reason =
      (path.empty() ? "\"\"" : path) + ": can't be made: " + failure.message();
  if (option) throw ConfigError(std::string(option) + ": " + reason);
  throw Error(reason);
}

void remove_file(const std::string& path) {
  std::error_code failure;
  std::filesystem::remove(path, failure);
  if (failure) throw Error(path + ": can't be removed: " + failure.message());
}

}  // namespace dmise
