#include "core/detector/read_noise.h"

#include "core/detector/detector.h"
#include "core/detector/detector_kernels.h"

namespace dmise {

std::span<const DetectorParameter> ReadNoise::parameters() {
  static constexpr DetectorParameter table[] = {
      {"read_noise_e", "", "[e-] rms", &ReadNoise::read_noise_e, 0.0, 1e6}};
  return table;
}

void ReadNoise::apply(const ExposureFacts& exposed, Piece& piece) const {
  const auto kernel =
      kernel_of(exposed.level, sse2::add_normal, avx2::add_normal, avx512::add_normal);
  kernel(exposed.key, std::uint32_t(piece.first), float(read_noise_e), piece.electrons.data(),
         piece.electrons.size());
}

}  // namespace dmise
