// Lines of night.jsonl: each is an exposure within the scenario, which is written as it was read,
// or refused with a ConfigError.
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "sensors/observatory/commanded_exposure.h"
#include "tests/observatory/small_scenario.h"

namespace {

using namespace dmise;

void require(bool holds) {
  if (!holds) __builtin_trap();
}

Scenario scenario() {
  const char* directory = std::getenv("TMPDIR");
  const std::string path =
      std::string(directory ? directory : "/tmp") + "/dmise-fuzz-night-" + std::to_string(getpid());
  Scenario small = small_observatory(path);
  std::filesystem::remove(path);
  return small;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Scenario small = scenario();
  try {
    const JsonRecord line(std::string(reinterpret_cast<const char*>(data), size), "night:1");
    const CommandedExposure e = read_commanded_exposure(line, small);
    require(is_within_run(small, small.sensors[0], e.times()));
    require(e.window.columns >= 1 && (e.window.x + e.window.columns) * e.window.bin_x <= 32);
    require(read_commanded_exposure(JsonRecord(to_json(e), "night:1"), small) == e);
    const SensorConfig sensor = commanded_sensor(small.sensors[0], e);
    require(std::isfinite(sensor.roll_deg) && sensor.exposure_s > 0.0);
  } catch (const ConfigError&) {
  }
  return 0;
}
