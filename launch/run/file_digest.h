#pragma once
#include <string>

namespace dmise {

/// SHA-256 of a catalogue's file; of an index of stars that of its checksums. A process reads a
/// file again only if it has changed.
std::string file_digest(const std::string& path);

}  // namespace dmise
