#pragma once
#include <cstddef>
#include <span>

namespace dmise {

/// Has every block of 256 KB or more mapped on its own, so that freeing an image gives its memory
/// back at once: the C library would otherwise keep it once the first was freed. To be called
/// before threads start.
void return_large_blocks();

/// Gives the memory of a range back while it stays allocated: whole pages of it are zero
/// afterwards, what is left at its ends as it was.
void release_pages(std::span<std::byte> range);

/// Asks for large pages behind a range from its next touch on: an image is mapped in tens of faults
/// instead of thousands.
void prefer_large_pages(std::span<std::byte> range);

}  // namespace dmise
