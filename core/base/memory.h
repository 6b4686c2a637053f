#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace dmise {

/// Makes malloc map every block of 256 KB or more on its own, so that freeing an image returns its
/// memory to the system at once; glibc would otherwise raise the threshold after the first free.
/// Call it before threads start.
void return_large_blocks();

/// Returns the whole pages within a range to the system while it stays allocated: they read as zero
/// afterwards, the rest of the range is unchanged.
void release_pages(std::span<std::byte> range);

/// Asks for large pages behind a range before it is first written: an image then takes tens of page
/// faults instead of thousands.
void prefer_large_pages(std::span<std::byte> range);

/// Zeros in large pages.
template <class T>
std::vector<T> zeros_in_large_pages(std::size_t count) {
  std::vector<T> out;
  out.reserve(count);
  prefer_large_pages(std::as_writable_bytes(std::span(out.data(), count)));
  out.resize(count);
  return out;
}

}  // namespace dmise
