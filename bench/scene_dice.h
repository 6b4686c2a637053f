#pragma once
#include <cmath>
#include <numbers>

#include "core/base/numeric/rng.h"
#include "core/frames/vec.h"

namespace dmise {

/// The random numbers of one drawn scene, one after the other.
class SceneDice {
 public:
  SceneDice(std::uint64_t seed, std::uint32_t scene)
      : key_(rng_key(seed, "scenes", scene, "scene")) {}

  double uniform() { return uniform_of(rng_word(key_, next_++, 0)); }
  double uniform(double least, double most) { return least + (most - least) * uniform(); }
  double log_uniform(double least, double most) {
    return least * std::pow(most / least, uniform());
  }
  bool chance(double probability) { return uniform() < probability; }
  int below(int count) { return int(uniform() * count); }
  template <class F>
  Vec<F> direction() {
    const double z = uniform(-1.0, 1.0), turn = 2.0 * std::numbers::pi * uniform();
    const double across = std::sqrt(1.0 - z * z);
    return {across * std::cos(turn), across * std::sin(turn), z};
  }

 private:
  RngKey key_;
  std::uint32_t next_ = 0;
};

}  // namespace dmise
