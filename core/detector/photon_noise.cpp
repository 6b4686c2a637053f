#include "core/detector/photon_noise.h"

#include "core/detector/poisson.h"

namespace dmise {

void PhotonNoise::apply(const ExposureFacts& exposed, Piece& piece) const {
  float* e = piece.electrons.data();
  poisson(exposed.key, std::uint32_t(piece.first), e, piece.electrons.size(), e, exposed.level);
}

}  // namespace dmise
