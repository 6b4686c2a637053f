#include "bench/sgp4_scale.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/status_memory.h"
#include "bench/timing.h"
#include "core/base/error.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/orbit/sgp4/synthetic_catalogue.h"

namespace dmise {
namespace {

Sgp4Scale measure(std::size_t objects, bool keep_elements) {
  constexpr std::size_t piece = 4096;
  std::vector<MeanElements> kept;
  if (keep_elements) kept = synthetic_catalogue({.objects = objects});
  Sgp4Batch batch(best_simd_level());
  for (std::size_t first = 0; first < objects; first += piece) {
    const std::size_t count = std::min(piece, objects - first);
    if (keep_elements)
      batch.append({&kept[first], count});
    else
      batch.append(synthetic_catalogue({.objects = count, .first = first}));
  }
  std::vector<double> position(3 * objects), velocity(3 * objects);
  std::vector<std::uint8_t> code(objects);
  std::vector<double> times_s;
  const auto calls = std::max<std::size_t>(9, 200'000 / objects);
  for (std::size_t k = 0; k <= calls; ++k) {
    const double start = thread_seconds();
    batch.propagate(2458138.5, 10.0 / 86400.0 * double(k), position, velocity, code);
    if (k > 0)
      times_s.push_back(thread_seconds() - start);  // the first pass page-faults the arrays
  }
  std::nth_element(times_s.begin(), times_s.begin() + long(calls / 2), times_s.end());
  return {.ns_per_object = 1e9 * times_s[calls / 2] / double(objects),
          .peak_mb = status_mb("VmHWM")};
}

}  // namespace

Sgp4Scale sgp4_at_scale(std::size_t objects, bool keep_elements) {
  int ends[2];
  if (pipe(ends) != 0) throw Error("can't create a pipe");
  const pid_t child = fork();
  if (child < 0) throw Error("can't start a process");
  if (child == 0) {
    int status = 1;
    try {
      const Sgp4Scale scale = measure(objects, keep_elements);
      status = write(ends[1], &scale, sizeof scale) != sizeof scale;
    } catch (...) {
    }
    _exit(status);
  }
  close(ends[1]);
  Sgp4Scale scale;
  const bool got = read(ends[0], &scale, sizeof scale) == sizeof scale;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!got || status != 0)
    throw Error("propagating " + std::to_string(objects) + " synthetic objects failed");
  return scale;
}

}  // namespace dmise
