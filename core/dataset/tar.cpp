#include "core/dataset/tar.h"

#include <cstdio>
#include <cstring>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr std::size_t block = 512;

struct UstarHeader {
  char name[100], mode[8], uid[8], gid[8], size[12], mtime[12], checksum[8], type, link[100],
      magic[6], version[2], owner[32], group[32], major[8], minor[8], prefix[155], unused[12];
};
static_assert(sizeof(UstarHeader) == block);

}  // namespace

std::string tar_member(std::string_view name, std::string_view content) {
  UstarHeader h{};
  if (name.size() > sizeof h.name || content.size() >= (std::size_t(1) << 33))
    throw Error(std::string(name) + ": can't be a member of a tar archive");
  std::memcpy(h.name, name.data(), name.size());
  std::memcpy(h.mode, "0000644", 8);
  std::memcpy(h.uid, "0000000", 8);
  std::memcpy(h.gid, "0000000", 8);
  std::snprintf(h.size, sizeof h.size, "%011lo", static_cast<unsigned long>(content.size()));
  std::memcpy(h.mtime, "00000000000", 12);
  std::memcpy(h.magic, "ustar", 6);
  std::memcpy(h.version, "00", 2);
  h.type = '0';
  std::memset(h.checksum, ' ', sizeof h.checksum);
  char bytes[block];
  std::memcpy(bytes, &h, block);
  unsigned sum = 0;
  for (const char c : bytes) sum += static_cast<unsigned char>(c);
  std::snprintf(h.checksum, sizeof h.checksum, "%06o", sum);  // then a NUL and the blank
  std::memcpy(bytes, &h, block);
  std::string member(bytes, block);
  member += content;
  member.append((block - content.size() % block) % block, '\0');
  return member;
}

std::string tar_end() { return std::string(2 * block, '\0'); }

}  // namespace dmise
