#pragma once
#include <string>

namespace dmise {

/// One measured figure. `anchor_value` and `target` 0: there is none.
struct Figure {
  std::string name;
  double value = 0.0;
  std::string unit;
  std::string anchor;  // what it is compared with, measured in the same run
  double anchor_value = 0.0;
  double target = 0.0;  // of `value`
  bool less_is_better = false;
};

/// One line on standard output: for people, or one JSON object.
void print_figure(const Figure& figure, bool json);

}  // namespace dmise
