// Any bytes are an index of stars that can be searched, or one ConfigError; never a crash.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/crc32c.h"
#include "core/sky/stars/star_map_file.h"

namespace {

const std::string& path() {
  static const std::string own = "/dev/shm/dmise-fuzz-stars-" + std::to_string(getpid());
  return own;
}

std::string small_map() {
  dmise::StarCatalogue stars;
  for (std::uint32_t i = 0; i < 20; ++i)
    dmise::append_star(stars,
                       {.id = i, .ra_rad = 0.3 * i, .dec_rad = 0.1 * i - 1, .v_mag = 0.5 * i});
  dmise::write_star_map(path(), dmise::star_map_of(std::move(stars)), {});
  std::ifstream file(path(), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void open(const std::string& bytes) {
  std::ofstream(path(), std::ios::binary | std::ios::trunc) << bytes;
  try {
    const dmise::OpenedStarMap opened = dmise::open_star_map(path());
    std::vector<std::uint32_t> found;
    dmise::query_cone(opened.map, {0, 0, 1}, 2.0, 12.0, found);
  } catch (const dmise::Error&) {
  }
  unlink(path().c_str());
}

}  // namespace

// A whole file, partly overwritten from the input, with the checksum that belongs to it then.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t crc_at = 12, columns_at_at = 48;
  static const std::string whole = small_map();
  if (size < 4) return 0;
  std::string changed = whole;
  const std::size_t at = std::size_t(data[0] | data[1] << 8) % changed.size();
  for (std::size_t i = 3; i < size && at + i - 3 < changed.size(); ++i)
    changed[at + i - 3] = static_cast<char>(data[i]);
  if (data[2] & 1) changed.resize(changed.size() * data[2] / 256);
  std::uint64_t columns_at = 0;
  if (changed.size() > columns_at_at + 8) {
    std::memset(changed.data() + crc_at, 0, 4);
    std::memcpy(&columns_at, changed.data() + columns_at_at, 8);
    const std::uint32_t crc =
        dmise::crc32c(changed.data(), std::min<std::size_t>(columns_at, changed.size()));
    std::memcpy(changed.data() + crc_at, &crc, 4);
  }
  open(changed);
  return 0;
}
