#pragma once
#include <cstddef>
#include <cstdint>

#include "core/base/numeric/simd_sets.h"
#include "core/orbit/sgp4/sgp4_terms.h"

// Functions that each instruction set's file provides to Sgp4Batch. Do not include headers with
// inline functions here: they would be compiled for an instruction set that the machine may lack.
namespace dmise::sgp4 {

/// States of one block [m, m/s], zeros where the code is not 0.
struct alignas(64) BlockStates {
  double position[3][block_lanes];
  double velocity[3][block_lanes];
  unsigned char code[block_lanes];
};

/// The caller's arrays: x at [i], y at [i + stride], z at [i + 2 stride], one time after the other.
/// Codes are initialised to 0: kernels write only the others.
struct Output {
  double* position;
  double* velocity;
  std::uint8_t* code;
  std::size_t stride;
};

/// UTC two-part Julian dates [d].
struct Instant {
  double jd1, jd2;
};
struct Instants {
  const Instant* at;
  std::size_t count;
};

/// Range of eccentricity, which selects the solver of Kepler's equation.
enum class Shape : std::uint8_t { circle, oval, any };

/// Terms of one block of deep-space objects, and of its resonance or null.
struct DeepBlock {
  const DeepTerms<Lanes>* terms;
  const SynchronousTerms<Lanes>* day;
  const HalfDayTerms<Lanes>* half_day;
  ResonanceNode* node;  // in and out: integrator node, with a resonance
  Shape shape;
  const DeepTerms<Lanes>* next = nullptr;  // next block to prefetch, or null
};

struct Kernels {
  /// `objects` near-Earth objects in blocks, each block at all times before the next; object k of
  /// them goes to `index[k]`, which ascend.
  void (*near_blocks)(const NearTerms<Lanes>* blocks, const std::uint32_t* index,
                      std::size_t objects, Shape shape, const Instants& times, const Output& out);
  /// One block of deep-space objects at all times.
  void (*deep_block_at)(const DeepBlock& block, const std::uint32_t* index, std::size_t objects,
                        const Instants& times, const Output& out);
  /// One block, each lane at its own minutes from epoch.
  void (*near_block)(const NearTerms<Lanes>& block, Shape shape, const Lanes& minutes,
                     BlockStates& out);
  void (*deep_block)(const DeepBlock& block, const Lanes& minutes, BlockStates& out);
};

}  // namespace dmise::sgp4

#define DMISE_SGP4_KERNELS(level)          \
  namespace dmise::level {                 \
  extern const sgp4::Kernels sgp4_kernels; \
  }
DMISE_EACH_SIMD_SET(DMISE_SGP4_KERNELS)
#undef DMISE_SGP4_KERNELS
