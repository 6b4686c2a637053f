#pragma once
#include <string>

namespace dmise {

/// One measured value. `anchor_value` and `target` are 0 if there is none.
struct Figure {
  std::string name;
  double value = 0.0;
  std::string unit;
  std::string anchor;  // comparison measured in the same run
  double anchor_value = 0.0;
  double target = 0.0;  // that `value` should reach
  bool less_is_better = false;
};

/// Prints one line of text or one JSON object.
void print_figure(const Figure& figure, bool json);

}  // namespace dmise
