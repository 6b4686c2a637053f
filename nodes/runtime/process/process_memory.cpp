#include "nodes/runtime/process/process_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <ctime>
#include <fstream>
#include <sstream>
#include <string>

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
  std::ifstream file("/proc/self/stat");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto name_end = text.rfind(')');
  if (name_end == std::string::npos) return 0.0;
  std::istringstream fields(text.substr(name_end + 1));
  std::string skipped;
  for (int field = 3; field < 22; ++field) fields >> skipped;  // numbered as in proc(5)
  double began = 0.0;
  fields >> began;
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  const double age_s = seconds_of(now) - began / double(sysconf(_SC_CLK_TCK));
  return age_s > 0.0 ? age_s : 0.0;
}

}  // namespace dmise
