#include "core/orbit/sgp4/sgp4_groups.h"

#include <sys/mman.h>

#include <algorithm>
#include <limits>
#include <new>

namespace dmise::sgp4 {
namespace {

constexpr double low_inclination_rad = 0.22;  // below it Lyddane's terms are likely

Shape shape_of(double eccentricity) {
  if (eccentricity < 0.025) return Shape::circle;
  return eccentricity < 0.18 ? Shape::oval : Shape::any;
}

}  // namespace

void* new_piece(bool whole) {
  void* piece = std::aligned_alloc(piece_bytes, piece_bytes);
  if (!piece) throw std::bad_alloc();
  if (whole) madvise(piece, piece_bytes, MADV_HUGEPAGE);  // optional, for speed
  return piece;
}

std::size_t group_of(const Model& m) {
  const auto shape = static_cast<std::size_t>(shape_of(m.eccentricity));
  if (!m.deep) return shape;
  const std::size_t low = m.inclination_rad < low_inclination_rad;
  return shape + shapes * (1 + 2 * static_cast<std::size_t>(m.resonance) + low);
}

ResonanceNode no_node() {
  ResonanceNode node{};
  for (double& t : node.time.lane) t = std::numeric_limits<double>::quiet_NaN();
  return node;
}

void Group::add(const Model& m, std::uint32_t object) {
  deep = m.deep;
  resonance = m.resonance;
  shape = shape_of(m.eccentricity);
  const int lane = static_cast<int>(index.size() % block_lanes);
  index.push_back(object);
  // A new block holds its first object in every lane, so that every lane has valid input.
  const int end = lane == 0 ? block_lanes : lane + 1;
  const auto take = [&](auto& blocks, const auto& one) {
    auto& block = lane == 0 ? blocks.add() : blocks.back();
    for (int k = lane; k < end; ++k) set_lane(block, k, one);
  };
  if (!deep) take(near, m.near);
  if (deep) take(far, m.far);
  if (resonance == Resonance::day) take(day, m.day);
  if (resonance == Resonance::half_day) take(half_day, m.half_day);
}

void Group::make_nodes() {
  if (resonance == Resonance::none) return;
  if (nodes.size() > 0) nodes.back() = no_node();  // its block may have gained objects
  while (nodes.size() < blocks()) nodes.add() = no_node();
  busy = std::make_unique<std::atomic_flag[]>(blocks());
}

std::size_t Group::first_block_from(std::size_t object) const {
  std::size_t low = 0, high = blocks();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (index[middle * block_lanes] < object)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

DeepBlock Group::deep_block(std::size_t k, ResonanceNode* node) const {
  return {&far[k],
          resonance == Resonance::day ? &day[k] : nullptr,
          resonance == Resonance::half_day ? &half_day[k] : nullptr,
          node,
          shape,
          k + 1 < far.size() ? &far[k + 1] : nullptr};
}

void Group::run(const Kernels& kernels, std::size_t begin, std::size_t end, const Instants& times,
                const Output& out) const {
  const std::size_t objects = std::min(end * block_lanes, index.size());
  for (std::size_t k = begin; !deep && k < end;) {
    const std::size_t next = std::min(end, near.end_of_piece(k));
    kernels.near_blocks(&near[k], &index[k * block_lanes],
                        std::min(next * block_lanes, objects) - k * block_lanes, shape, times, out);
    k = next;
  }
  for (std::size_t k = begin; deep && k < end; ++k) {
    const std::uint32_t* places = &index[k * block_lanes];
    const std::size_t left = objects - k * block_lanes;
    if (resonance == Resonance::none) {
      kernels.deep_block_at(deep_block(k, nullptr), places, left, times, out);
    } else if (!busy[k].test_and_set(std::memory_order_acquire)) {
      kernels.deep_block_at(deep_block(k, &nodes[k]), places, left, times, out);
      busy[k].clear(std::memory_order_release);
    } else {
      ResonanceNode own = no_node();
      kernels.deep_block_at(deep_block(k, &own), places, left, times, out);
    }
  }
}

}  // namespace dmise::sgp4
