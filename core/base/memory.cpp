#include "core/base/memory.h"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace dmise {

void return_large_blocks() { mallopt(M_MMAP_THRESHOLD, 1 << 18); }

namespace {

/// madvise on the whole pages of a range.
void advise(void* begin, std::size_t bytes, int advice) {
  static const auto page = std::uintptr_t(sysconf(_SC_PAGESIZE));
  const auto at = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (at + page - 1) / page * page, last = (at + bytes) / page * page;
  if (last > first) madvise(reinterpret_cast<void*>(first), last - first, advice);
}

}  // namespace

void release_pages(void* begin, std::size_t bytes) { advise(begin, bytes, MADV_DONTNEED); }

void prefer_large_pages(void* begin, std::size_t bytes) { advise(begin, bytes, MADV_HUGEPAGE); }

}  // namespace dmise
