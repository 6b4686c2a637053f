#pragma once
#include <cstddef>
#include <cstdint>

#include "core/orbit/sgp4_terms.h"

// What each instruction set's file gives to Sgp4Batch. No header with inline functions of its own
// may be included here: it would be compiled for a set that the machine may not have.
namespace dmise::sgp4 {

/// States of one block [m, m/s], zeros where the code is not 0.
struct alignas(64) BlockStates {
  double position[3][block_lanes];
  double velocity[3][block_lanes];
  unsigned char code[block_lanes];
};

/// The caller's arrays: x at [i], y at [i + stride], z at [i + 2 stride].
struct Output {
  double* position;
  double* velocity;
  std::uint8_t* code;
  std::size_t stride;
};

/// Terms of one block of deep-space objects; those of its resonance or null.
struct DeepBlock {
  const DeepTerms<Lanes>* terms;
  const SynchronousTerms<Lanes>* day;
  const HalfDayTerms<Lanes>* half_day;
  ResonanceNode* node;  // where to start from and what is left behind, with a resonance
  bool eccentric;
};

struct Kernels {
  /// `objects` near-Earth objects in blocks, at one time; object k of them goes to `index[k]`.
  void (*near_blocks)(const NearTerms<Lanes>* blocks, const std::uint32_t* index,
                      std::size_t objects, bool eccentric, double jd1, double jd2,
                      const Output& out);
  /// One block, each lane at its own minutes from epoch.
  void (*near_block)(const NearTerms<Lanes>& block, bool eccentric, const Lanes& minutes,
                     BlockStates& out);
  void (*deep_block)(const DeepBlock& block, const Lanes& minutes, BlockStates& out);
  /// One block of deep-space objects at one time, written to `index`.
  void (*deep_block_at)(const DeepBlock& block, const std::uint32_t* index, int objects, double jd1,
                        double jd2, const Output& out);
};

extern const Kernels kernels_sse2, kernels_avx2, kernels_avx512;

}  // namespace dmise::sgp4
