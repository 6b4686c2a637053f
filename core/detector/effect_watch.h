#pragma once
#include <chrono>

#include "core/effects/effects.h"

namespace dmise {

/// Gives each effect the seconds since the one before. Nothing of it gets into a product.
class EffectWatch {
 public:
  explicit EffectWatch(EffectTimes& times) : times_(times), lap_(Clock::now()) {}
  void charge(Effect effect) {
    const auto now = Clock::now();
    times_[effect] += std::chrono::duration<double>(now - lap_).count();
    lap_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  EffectTimes& times_;
  Clock::time_point lap_;
};

}  // namespace dmise
