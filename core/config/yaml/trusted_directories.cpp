#include "core/config/yaml/trusted_directories.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/base/files/user_directories.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_list_bytes = 1 << 20;

/// Why what is at `path` may be somebody else's word; empty if it can't be.
std::string why_unsafe(const fs::path& path) {
  struct stat info {};
  const std::string text = printable(path.string());
  if (stat(path.c_str(), &info) != 0) return text + ": " + std::strerror(errno);
  if (info.st_uid != geteuid()) return text + " is not yours";
  if (info.st_mode & (S_IWGRP | S_IWOTH)) return "others may write to " + text + " (chmod go-w)";
  return "";
}

bool is_within(const fs::path& path, const fs::path& top) {
  return std::ranges::mismatch(path, top).in2 == top.end();
}

struct Trusted {
  fs::path directory;
  int line = 0;
};

/// The first line of the list that has the directory or one above it.
std::optional<Trusted> line_for(const fs::path& directory, const std::string& list) {
  const std::string text = read_text_file(list, longest_list_bytes);
  LineReader lines(text);
  while (const auto line = lines.next()) {
    const std::string_view path = trimmed(*line);
    if (path.empty() || path.starts_with('#')) continue;
    if (!path.starts_with('/'))
      throw ConfigError(
          at_line(list, lines.line(), "must be an absolute path, got " + printable(path)));
    std::error_code missing;
    fs::path trusted = fs::canonical(path, missing);
    if (!missing && is_within(directory, trusted)) return Trusted{std::move(trusted), lines.line()};
  }
  return std::nullopt;
}

}  // namespace

std::string trusted_directories_file() {
  const std::string directory = config_directory();
  return directory.empty() ? "" : directory + "/trusted-directories";
}

std::string why_not_trusted(const std::string& directory, const std::string& list) {
  std::error_code missing;
  const fs::path real = fs::canonical(directory, missing);
  const bool listed = !missing && fs::exists(list, missing);
  const auto trusted = listed ? line_for(real, list) : std::nullopt;
  if (!trusted)
    return "no line of " + printable(list) + " is " + printable(real.string()) + " or above it";
  std::string why = why_unsafe(list);
  if (why.empty()) why = why_unsafe(fs::path(list).parent_path());
  for (fs::path each = real; why.empty() && is_within(each, trusted->directory);
       each = each.parent_path()) {
    why = why_unsafe(each);
    if (each == each.parent_path()) break;
  }
  return why.empty() ? "" : at_line(list, trusted->line, "does not count: " + why);
}

}  // namespace dmise
