#include "core/config/yaml/search_path.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "core/base/files/user_directories.h"
#include "core/base/own_file.h"

namespace dmise {

namespace fs = std::filesystem;

std::string home_directory() {
  if (const char* home = std::getenv("DMISE_HOME")) return home;
  std::error_code ignored;
  for (auto dir = fs::path(own_file()).parent_path(); !dir.empty(); dir = dir.parent_path()) {
    if (fs::is_directory(dir / "launch" / "cameras", ignored)) return dir.string();
    if (fs::is_directory(dir / "share/dmise/launch/cameras", ignored))
      return (dir / "share/dmise").string();
    if (dir == dir.root_path()) break;
  }
  return ".";
}

std::string find_beside(const std::string& name, const std::string& from_file) {
  std::error_code ignored;
  for (const auto& candidate : {fs::path(from_file).parent_path() / name, fs::path(name)})
    if (fs::is_regular_file(candidate, ignored)) return candidate.lexically_normal().string();
  return "";
}

std::string find_preset(const std::string& kind, const std::string& name,
                        const std::string& from_file) {
  if (const auto beside = find_beside(name, from_file); !beside.empty()) return beside;
  std::error_code ignored;
  const auto preset = fs::path(home_directory()) / "launch" / kind / (name + ".yaml");
  return fs::is_regular_file(preset, ignored) ? preset.lexically_normal().string() : "";
}

std::vector<std::string> preset_names(const std::string& kind) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry :
       fs::directory_iterator(fs::path(home_directory()) / "launch" / kind, ignored))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

const char* object_catalogue_file(const std::string& name) {
  return name == default_object_catalogue || name == "gpredict" ? "demo.tle" : nullptr;
}

std::string find_catalogue(const std::string& file_name) {
  std::error_code ignored;
  for (const auto& directory :
       {fs::path(home_directory()) / "launch/catalogues", fs::path(home_directory()) / "build/data",
        fs::path(data_directory())})
    if (fs::is_regular_file(directory / file_name, ignored))
      return (directory / file_name).string();
  return "";
}

std::string missing_catalogue(const std::string& file_name) {
  return home_directory() + "/launch/catalogues/" + file_name +
         " is missing; DMISE_HOME must be the directory that launch/ is in";
}

}  // namespace dmise
