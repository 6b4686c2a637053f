#include "launch/scenes/star_index_files.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/crc32c.h"
#include "core/base/files/digest.h"
#include "core/base/files/mapped_file.h"
#include "core/base/files/paths.h"
#include "core/base/files/regular_file.h"
#include "core/base/files/text_file.h"
#include "core/base/files/user_directories.h"
#include "core/base/printable.h"
#include "core/config/star_catalogues.h"
#include "core/config/yaml/search_path.h"
#include "core/sky/stars/star_file.h"
#include "core/sky/stars/star_map_file.h"
#include "core/sky/stars/star_merge.h"
#include "launch/command/notes.h"
#include "launch/process/supervisor.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

constexpr const char* deep_stars_name = "deepstars.dat";
/// The file of 2,412,252 records that the tests were run with has this hash.
constexpr std::string_view deep_stars_sha256 =
    "136301c017094044d24b74711eeb3d693e908ec6d31c0f217a05565fb4704a00";

/// Runs a program and returns the first line of its standard error; empty if it exited with 0.
std::string failure_of(std::vector<std::string> command) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return std::strerror(errno);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  pid_t child = 0;
  const int refused = posix_spawn(&child, command[0].c_str(), &actions, nullptr,
                                  pointers_to(command).data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string said;
  std::array<char, 4096> piece;
  for (ssize_t n; (n = read(ends[0], piece.data(), piece.size())) != 0;) {
    if (n > 0) said.append(piece.data(), std::size_t(n));
    if (n < 0 && errno != EINTR) break;
  }
  close(ends[0]);
  if (refused != 0) return command[0] + ": " + std::strerror(refused);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  return said.empty() ? command[0] + " failed" : said.substr(0, said.find('\n'));
}

std::string directory_for(const std::string& to) {
  if (!to.empty()) return to;
  const std::string of_checkout = home_directory() + "/build/data";
  if (access(of_checkout.c_str(), W_OK) == 0) return of_checkout;
  if (data_directory().empty()) throw ConfigError("--to: there is no home directory; say where to");
  return data_directory();
}

/// Content of deepstars.dat: of the file in the directory, if `from` is empty and it exists, else
/// of one that is fetched.
std::string deep_stars(const std::string& directory, const std::string& from) {
  const std::string kept = directory + "/" + deep_stars_name;
  if (from.empty() && access(kept.c_str(), R_OK) == 0) return read_text_file(kept);
  const std::string why =
      failure_of({home_directory() + "/launch/setup/fetch-tycho2.sh", directory, from});
  if (!why.empty()) throw ConfigError(why);
  std::string content = read_text_file(kept);
  std::error_code ignored;  // if it stays, it only takes space
  fs::remove(kept, ignored);
  return content;
}

/// Checksum and size of a source, as the cache of catalogues uses them.
StarSource source_of(std::string_view bytes) {
  return {crc32c(bytes.data(), bytes.size()), bytes.size()};
}

/// Content of a catalogue's file, mapped if it is not compressed: it may be larger than the memory.
struct CatalogueBytes {
  explicit CatalogueBytes(const std::string& path) : file(path) {
    const auto bytes = file.bytes();
    text = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    if (!text.starts_with("\x1f\x8b")) return;
    unpacked = read_text_file(path);
    text = unpacked;
  }
  MappedFile file;
  std::string unpacked;
  std::string_view text;
};

}  // namespace

std::string fetch_tycho2(const std::string& from, const std::string& to) {
  const std::string bright_path = find_catalogue(star_catalogue_file("kstars"));
  if (bright_path.empty()) throw ConfigError(missing_star_catalogue("kstars"));
  const std::string directory = directory_for(to);
  make_directories(directory, "--to");
  const std::string deep = deep_stars(directory, from);
  if (const std::string digest = sha256_hex(deep); digest != deep_stars_sha256)
    throw ConfigError(std::string(deep_stars_name) + ": its SHA-256 must be " +
                      std::string(deep_stars_sha256) + ", is " + digest);
  StarReading bright = parse_stars(read_text_file(bright_path), bright_path);
  const StarReading faint = parse_stars(deep, deep_stars_name);
  const std::string path = directory + "/" + star_catalogue_file("tycho2");
  write_star_map(path, star_map_of(merge_stars(std::move(bright.catalogue), faint.catalogue)),
                 source_of(deep));
  return path;
}

std::size_t index_stars(const std::string& from, const std::string& to) try {
  std::error_code missing;
  if (fs::equivalent(from, to, missing))
    throw ConfigError("--out: must be another file than the catalogue, got " + printable(to));
  const std::string index = file_to_write("--out", to);
  const CatalogueBytes bytes(from);
  StarReading reading = parse_stars(bytes.text, from);
  for (const std::string& problem : reading.problems) print_note(problem + " (left out)");
  const StarSource source = source_of(bytes.text);
  const StarMap map = star_map_of(std::move(reading.catalogue), std::move(reading.problems));
  write_star_map(index, map, source);
  return map.stars.size();
} catch (const ConfigError&) {
  throw;
} catch (const Error& error) {  // a file that is not there
  throw ConfigError(error.what());
}

}  // namespace dmise
