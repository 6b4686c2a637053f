#pragma once
#include <cstdlib>

// Included once by a test that uses ZeroMQ: ThreadSanitizer takes no notice of what libzmq does
// inside, here and in child processes.
#ifdef __SANITIZE_THREAD__
inline constexpr const char* tsan_options =
    "atexit_sleep_ms=0:suppressions=" DMISE_SOURCE_DIR "/tests/support/tsan.supp";
extern "C" const char* __tsan_default_options() { return tsan_options; }
namespace {
[[maybe_unused]] const int told_children = setenv("TSAN_OPTIONS", tsan_options, 0);
}
#endif
