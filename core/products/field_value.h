#pragma once

namespace dmise {

/// The value of a field in the unit of its row in a table of fields; a unit that is the whole
/// number 1 stands for values as they are, texts and flags among them.
inline double in_unit(double value, double unit) { return value / unit; }
template <class T>
T in_unit(const T& value, int) {
  return value;
}

}  // namespace dmise
