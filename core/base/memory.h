#pragma once

namespace dmise {

/// Has every block of 256 KB or more mapped on its own, so that freeing an image gives its memory
/// back at once: the C library would otherwise keep it once the first was freed. To be called
/// before threads start.
void return_large_blocks();

}  // namespace dmise
