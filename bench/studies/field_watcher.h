#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "core/config/scenario.h"
#include "core/sim/participant.h"

namespace dmise {

/// A scenario of `sensors` telescopes on the ground over a catalogue of 18,470 objects, with an
/// exposure in every tick. The files are written to `directory`.
Scenario telescope_network(int sensors, Tick ticks, const std::filesystem::path& directory);

/// A sensor that does all that a sensor does with objects before it draws: keeps the states of the
/// world, and finds for every exposure which objects are in its field, and where. Makes no frame.
std::unique_ptr<Participant> make_field_watcher(const Scenario& scenario, const std::string& name);

}  // namespace dmise
