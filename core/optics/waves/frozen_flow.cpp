#include "core/optics/waves/frozen_flow.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {

FrozenFlow::FrozenFlow(int side, double outer_scale, const RngKey& key)
    : screens_(side, outer_scale), length_((screens_.torus() - side) / 2), key_(key) {}

// Tori are drawn in pairs; four are cached: the two that a window blends and the other halves of
// their pairs.
const FrozenFlow::Field& FrozenFlow::field(std::int64_t block) {
  const std::int64_t pair = block >= 0 ? block / 2 : (block - 1) / 2;
  Field* slots = kept_ + 2 * (pair & 1);
  if (slots[0].block != 2 * pair) {
    const auto tilts = screens_.draw_fields(key_, std::uint32_t(pair) & 0x7fffffffu, slots[0].phase,
                                            slots[1].phase);
    for (int i = 0; i < 2; ++i) {
      slots[i].block = 2 * pair + i;
      slots[i].tilt = tilts[std::size_t(i)];
    }
  }
  return slots[block - 2 * pair];
}

PhaseScreen FrozenFlow::at(double distance, double direction_rad, double r0_samples) {
  if (!(std::abs(distance) < 1e12)) throw Error("frozen flow: the screen moved too far");
  const int side = screens_.side(), torus = screens_.torus();
  const auto around = [&](double shift) {
    const auto rest = std::int64_t(std::llround(shift)) % torus;
    return rest < 0 ? rest + torus : rest;
  };
  const std::int64_t left = around(distance * std::cos(direction_rad)),
                     up = around(distance * std::sin(direction_rad));
  const auto block = std::int64_t(std::floor(distance / length_));
  const double fade = 0.5 * pi * (distance / length_ - double(block));
  const double scale = std::pow(r0_samples, -5.0 / 6);  // for the phase: D goes as r0^(-5/3)
  PhaseScreen window{side, std::vector<float>(std::size_t(side) * std::size_t(side))};
  const auto add = [&](const Field& f, double weight) {
    for (int y = 0; y < side; ++y) {
      // The wind brings new phase from its upwind side.
      const float* row = f.phase.data() + std::size_t((y - up + torus) % torus * torus);
      float* out = window.phase_rad.data() + std::size_t(y) * std::size_t(side);
      for (int x = 0; x < side; ++x)
        out[x] += float(weight * (row[(x - left + torus) % torus] + f.tilt.x * x + f.tilt.y * y));
    }
  };
  add(field(block), scale * std::cos(fade));
  if (fade > 0.0) add(field(block + 1), scale * std::sin(fade));
  return window;
}

}  // namespace dmise
