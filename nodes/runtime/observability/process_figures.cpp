#include <filesystem>

#include "nodes/runtime/observability/figures.h"
#include "nodes/runtime/process/cpu_time.h"
#include "nodes/runtime/process/process_memory.h"

namespace dmise {

ProcessFigures process_figures() {
  ProcessFigures figures;
  figures.cpu_s = process_cpu_seconds();
  figures.resident_bytes = process_memory().resident_bytes;
  std::error_code ignored;
  for (std::filesystem::directory_iterator file("/proc/self/fd", ignored), end; file != end;
       file.increment(ignored))
    ++figures.open_files;
  return figures;
}

}  // namespace dmise
