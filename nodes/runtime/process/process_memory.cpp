#include "nodes/runtime/process/process_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <ctime>
#include <fstream>
#include <string>

#include "nodes/runtime/process/process_stat.h"

namespace dmise {
namespace {

double seconds_of(const timespec& t) { return double(t.tv_sec) + 1e-9 * double(t.tv_nsec); }

}  // namespace

ProcessMemory process_memory() {
  ProcessMemory memory;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  memory.peak_resident_bytes = std::uint64_t(usage.ru_maxrss) * 1024;
  std::uint64_t pages = 0, resident = 0, of_files = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident >> of_files;
  const auto page_bytes = std::uint64_t(sysconf(_SC_PAGESIZE));
  memory.resident_bytes = resident * page_bytes;
  if (resident > of_files) memory.private_bytes = (resident - of_files) * page_bytes;
  return memory;
}

double process_cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return seconds_of(t);
}

double process_age_s() {
  constexpr std::size_t start_time = 22 - 3;  // numbered as in proc(5)
  const auto fields = process_stat(getpid());
  if (fields.size() <= start_time) return 0.0;
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  const double age_s =
      seconds_of(now) - std::stod(fields[start_time]) / double(sysconf(_SC_CLK_TCK));
  return age_s > 0.0 ? age_s : 0.0;
}

}  // namespace dmise
