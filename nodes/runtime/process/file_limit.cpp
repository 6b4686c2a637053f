#include "nodes/runtime/process/file_limit.h"

#include <sys/resource.h>

#include <algorithm>

namespace dmise {

void raise_file_limit() {
  constexpr rlim_t enough = 65536;
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur >= enough) return;
  files.rlim_cur = std::min(files.rlim_max, enough);  // RLIM_INFINITY is the largest
  setrlimit(RLIMIT_NOFILE, &files);
}

}  // namespace dmise
