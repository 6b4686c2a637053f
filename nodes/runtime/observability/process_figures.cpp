#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "nodes/runtime/observability/figures.h"

namespace dmise {

ProcessFigures process_figures() {
  ProcessFigures figures;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  figures.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  std::uint64_t pages = 0, resident_pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident_pages;
  figures.resident_bytes = resident_pages * std::uint64_t(sysconf(_SC_PAGESIZE));
  std::error_code ignored;
  for (std::filesystem::directory_iterator file("/proc/self/fd", ignored), end; file != end;
       file.increment(ignored))
    ++figures.open_files;
  return figures;
}

}  // namespace dmise
