#pragma once
#include <string>
#include <variant>
#include <vector>

#include "core/config/objects/object_config.h"
#include "core/orbit/elements/elements.h"
#include "core/orbit/motion.h"

namespace dmise {

using StatedModel = std::variant<MotionModel, MeanElements>;

/// Motion of the object with this name or number: one of the scenario's own, else of a
/// constellation or a catalogue, which is read for it. Throws `Error` if there is none, or if that
/// moves near another object itself.
StatedModel motion_named(const std::string& name, const std::vector<OwnObject>& own,
                         const std::vector<ObjectSource>& catalogues);

}  // namespace dmise
