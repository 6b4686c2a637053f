#pragma once
#include <cstdint>
#include <span>

#include "core/detector/poisson.h"

namespace dmise {

/// Electrons that heat frees during the exposure: a Poisson deviate of its own in every pixel (the
/// sum with the photo-electrons is distributed as one draw of the summed means).
class DarkCurrent {
 public:
  /// `mean_e` of the exposure, rate times time, >= 0.
  explicit DarkCurrent(double mean_e) : deviates_(static_cast<float>(mean_e)) {}
  void add(const RngKey& key, std::uint32_t first, std::span<float> electrons,
           SimdLevel level) const {
    deviates_.add(key, first, electrons.data(), electrons.size(), level);
  }

 private:
  ConstantPoisson deviates_;
};

}  // namespace dmise
