#pragma once
#include <cstdio>
#include <string>

#include "core/base/printable.h"

namespace dmise {

/// Prints a line "note: TEXT" on stderr, as `printable`: names in it come from files.
inline void print_note(const std::string& text) {
  std::fprintf(stderr, "note: %s\n", printable(text, 4000).c_str());
}

/// Prints a warning likewise.
inline void print_warning(const std::string& text) {
  std::fprintf(stderr, "note: warning: %s\n", printable(text, 4000).c_str());
}

}  // namespace dmise
