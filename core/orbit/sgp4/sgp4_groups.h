#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <type_traits>
#include <vector>

#include "core/orbit/sgp4/sgp4_kernels.h"
#include "core/orbit/sgp4/sgp4_terms.h"

namespace dmise::sgp4 {

inline constexpr std::size_t piece_bytes = std::size_t{1} << 21;  // a huge page

/// Allocates `piece_bytes` of memory that is committed when first written. `whole`: all of it will
/// be used, so huge pages are allowed.
void* new_piece(bool whole);

/// Blocks in chunks that never move, so that growing never copies.
template <class Block>
class Blocks {
 public:
  std::size_t size() const { return size_; }
  Block& add() {
    if (size_ % per_piece == 0)
      pieces_.emplace_back(static_cast<Block*>(new_piece(!pieces_.empty())));
    return (*this)[size_++];
  }
  Block& back() { return (*this)[size_ - 1]; }
  Block& operator[](std::size_t k) { return pieces_[k / per_piece].get()[k % per_piece]; }
  const Block& operator[](std::size_t k) const {
    return pieces_[k / per_piece].get()[k % per_piece];
  }
  /// End of the run of contiguous blocks that contains block `k`.
  std::size_t end_of_piece(std::size_t k) const { return (k / per_piece + 1) * per_piece; }

 private:
  static_assert(std::is_trivial_v<Block>);
  struct Free {
    void operator()(Block* piece) const { std::free(piece); }
  };
  static constexpr std::size_t per_piece = piece_bytes / sizeof(Block);
  std::vector<std::unique_ptr<Block, Free>> pieces_;
  std::size_t size_ = 0;
};

ResonanceNode no_node();

/// Objects that take the same branches of the model, in blocks, in catalogue order.
struct Group {
  bool deep = false;
  Resonance resonance = Resonance::none;
  Shape shape = Shape::circle;
  std::vector<std::uint32_t> index;  // which object each lane has
  Blocks<NearTerms<Lanes>> near;
  Blocks<DeepTerms<Lanes>> far;
  Blocks<SynchronousTerms<Lanes>> day;
  Blocks<HalfDayTerms<Lanes>> half_day;
  // Cached integrator node of each block: the thread that holds the block's lock starts from it and
  // updates it; others start from the epoch and find the same result more slowly.
  mutable Blocks<ResonanceNode> nodes;
  std::unique_ptr<std::atomic_flag[]> busy;

  /// Adds object number `object`; all objects of a group have the same `group_of`.
  void add(const Model& model, std::uint32_t object);
  /// Call after the last of a series of additions.
  void make_nodes();

  std::size_t blocks() const { return deep ? far.size() : near.size(); }
  /// The first block whose first object is not before `object`.
  std::size_t first_block_from(std::size_t object) const;
  DeepBlock deep_block(std::size_t k, ResonanceNode* node) const;
  /// Blocks [begin, end) at all times.
  void run(const Kernels& kernels, std::size_t begin, std::size_t end, const Instants& times,
           const Output& out) const;
};

inline constexpr std::size_t shapes = 3;
inline constexpr std::size_t group_count = shapes * 7;
std::size_t group_of(const Model& model);

}  // namespace dmise::sgp4
