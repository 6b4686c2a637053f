#include "core/base/memory.h"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace dmise {

void return_large_blocks() {
  mallopt(M_MMAP_THRESHOLD, 1 << 18);
  mallopt(M_TRIM_THRESHOLD, 1 << 22);  // smaller blocks are soon reused
}

namespace {

/// madvise on the whole pages of a range.
void advise(std::span<std::byte> range, int advice) {
  static const auto page = std::uintptr_t(sysconf(_SC_PAGESIZE));
  const auto at = reinterpret_cast<std::uintptr_t>(range.data());
  const std::uintptr_t first = (at + page - 1) / page * page,
                       last = (at + range.size()) / page * page;
  if (last > first) madvise(reinterpret_cast<void*>(first), last - first, advice);
}

}  // namespace

void release_pages(std::span<std::byte> range) { advise(range, MADV_DONTNEED); }

void prefer_large_pages(std::span<std::byte> range) { advise(range, MADV_HUGEPAGE); }

}  // namespace dmise
