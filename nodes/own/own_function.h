#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/own/own_node_run.h"

namespace dmise {

/// A request to the model of a node in this process, its first frame an OwnNodeRequest. It is that
/// of a sensor if it works for one. All ends with the call.
struct FunctionRequest {
  std::string_view node, sensor;
  OwnModel::Frames frames;
};

/// Returns the frames of the answer, the first an OwnNodeAnswer. With `begin` it makes a new model.
using ModelFunction = std::function<std::vector<std::string>(const FunctionRequest&)>;

/// Starts models that a function of this process speaks for. What it throws, each of their calls
/// throws.
ModelStarter functions_in_process(ModelFunction function);

}  // namespace dmise
