#include "core/run/run_files.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/files/paths.h"

namespace dmise {

bool is_file_of_sensor(std::string_view name) {
  constexpr std::string_view partial = ".partial", frame = "frame-", digits = "0123456789";
  constexpr std::string_view journal = "tasks.journal";  // a sensor that is cued writes it
  if (name.ends_with(partial)) name.remove_suffix(partial.size());
  if (name == journal || std::ranges::any_of(run_file::of_sensor, [&](const RunFile& file) {
        return name == file.name;
      }))
    return true;
  const auto end = name.find_first_not_of(digits, frame.size());
  return name.starts_with(frame) && end != name.npos && end > frame.size() &&
         std::ranges::find(frame_endings, name.substr(end)) != frame_endings.end();
}

std::string path_in(const std::string& directory, const RunFile& file) {
  return directory + "/" + file.name;
}

std::string existing_path(const std::string& directory, const RunFile& file) {
  std::string path = path_in(directory, file);
  if (!path_exists(path)) throw ConfigError(path + ": is missing: " + file.why_missing);
  return path;
}

}  // namespace dmise
