#pragma once
#include <cstddef>
#include <initializer_list>
#include <vector>

#include "core/frames/vec.h"

namespace dmise {

/// Writes column `i` of a matrix in rows of `count` numbers, such as those of `ObjectStates`.
inline void set_column(std::vector<double>& rows, std::size_t count, std::size_t i,
                       std::initializer_list<double> values) {
  for (const double value : values) {
    rows[i] = value;
    i += count;
  }
}
template <class F>
void set_column(std::vector<double>& rows, std::size_t count, std::size_t i, const Vec<F>& v) {
  set_column(rows, count, i, {v.x, v.y, v.z});
}

}  // namespace dmise
