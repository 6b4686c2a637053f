#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "sensors/observatory/observatory.h"
#include "tests/observatory/small_scenario.h"

namespace dmise {

/// An observatory of one small camera in `directory`, which is made anew.
struct ServedObservatory {
  ServedObservatory(const std::string& directory, std::shared_ptr<const ObservatoryClock> time,
                    const std::string& keys = {})
      : out(made_anew(directory)),
        scenario(small_observatory(out + "/scenario.yaml", keys)),
        scene(load_scene(scenario, make_clock(scenario))),
        clock(std::move(time)),
        observatory(scenario, scene, "digest", out, {.readout_s = 0.0}, *clock,
                    [](const std::string&) {}) {}

  static std::string made_anew(const std::string& directory) {
    std::filesystem::remove_all(directory);
    std::filesystem::create_directories(directory);
    return directory;
  }

  std::string out;
  Scenario scenario;
  ScenarioInputs scene;
  std::shared_ptr<const ObservatoryClock> clock;
  Observatory observatory;
};

}  // namespace dmise
