#pragma once
#include <vector>

#include "core/orbit/sgp4/sgp4_batch.h"

namespace dmise {

/// States of a whole batch at one instant, as a structure of arrays.
struct BatchStates {
  std::vector<double> position_m, velocity_m_per_s;  // 3 n
  std::vector<std::uint8_t> code;                    // n

  explicit BatchStates(std::size_t n) : position_m(3 * n), velocity_m_per_s(3 * n), code(n) {}
  static Vec<Teme> vec(const std::vector<double>& v, std::size_t i) {
    const std::size_t n = v.size() / 3;
    return {v[i], v[n + i], v[2 * n + i]};
  }
  Vec<Teme> place_m(std::size_t i) const { return vec(position_m, i); }
  Vec<Teme> speed_m_per_s(std::size_t i) const { return vec(velocity_m_per_s, i); }
};

}  // namespace dmise
