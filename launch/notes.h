#pragma once
#include <cstdio>
#include <string>

#include "core/base/printable.h"

namespace dmise {

/// A line "note: TEXT" on stderr, which a terminal shows and does not obey: names in it are of
/// other people's files.
inline void print_note(const std::string& text) {
  std::fprintf(stderr, "note: %s\n", printable(text, 4000).c_str());
}

/// The same of what is probably not meant.
inline void print_warning(const std::string& text) {
  std::fprintf(stderr, "note: warning: %s\n", printable(text, 4000).c_str());
}

}  // namespace dmise
