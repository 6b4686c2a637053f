#include "core/base/numeric/rng.h"

#include <Random123/philox.h>

#include <algorithm>

#include "core/base/numeric/rng_kernels.h"

namespace dmise {
namespace {

// FNV-1a over 64 bits, then the finaliser of SplitMix64 so that every bit depends on every other.
std::uint64_t hash_bytes(std::uint64_t h, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) h = (h ^ bytes[i]) * 0x100000001b3u;
  return h;
}

std::uint64_t mix(std::uint64_t h) {
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
  return h ^ (h >> 31);
}

// The length is hashed, too, so that ("ab", "c") and ("a", "bc") differ.
std::uint64_t hash_text(std::uint64_t h, std::string_view text) {
  const auto length = static_cast<std::uint64_t>(text.size());
  for (int byte = 0; byte < 8; ++byte) {
    const auto b = static_cast<unsigned char>(length >> (8 * byte));
    h = hash_bytes(h, &b, 1);
  }
  return hash_bytes(h, text.data(), text.size());
}

}  // namespace

RngKey rng_key(std::uint64_t seed, std::string_view sensor, std::uint32_t frame,
               std::string_view effect) {
  const std::uint64_t names = hash_text(hash_text(0xcbf29ce484222325u, sensor), effect);
  const std::uint64_t h = mix(names ^ mix(seed + 0x9e3779b97f4a7c15u));
  const std::uint64_t more = mix(h + 0x9e3779b97f4a7c15u);
  return {{std::uint32_t(h), std::uint32_t(h >> 32)}, {frame, std::uint32_t(more)}};
}

std::array<std::uint32_t, 4> rng_block(const RngKey& key, std::uint32_t block, std::uint32_t draw) {
  const r123::Philox4x32::ctr_type counter{{block, draw, key.stream[0], key.stream[1]}};
  const r123::Philox4x32::key_type words{{key.key[0], key.key[1]}};
  const auto r = r123::Philox4x32()(counter, words);
  return {r[0], r[1], r[2], r[3]};
}

std::uint32_t rng_word(const RngKey& key, std::uint32_t pixel, std::uint32_t draw) {
  const std::uint32_t i = pixel % rng_group;
  return rng_block(key, pixel / rng_group * 8 + i % 16 / 2, draw)[i / 16 * 2 + i % 2];
}

void rng_words(const RngKey& key, std::uint32_t first, std::size_t count, std::uint32_t draw,
               std::uint32_t* out, SimdLevel level) {
  const std::size_t head =
      std::min<std::size_t>(count, (rng_group - first % rng_group) % rng_group);
  for (std::size_t i = 0; i < head; ++i) out[i] = rng_word(key, first + std::uint32_t(i), draw);
  const std::size_t whole = (count - head) / rng_group * rng_group;
  kernel_of(level, sse2::rng_groups, avx2::rng_groups, avx512::rng_groups)(
      key, first + std::uint32_t(head), whole, draw, out + head);
  for (std::size_t i = head + whole; i < count; ++i)
    out[i] = rng_word(key, first + std::uint32_t(i), draw);
}

float normal_of(std::uint32_t word) {
  float z;
  sse2::normals_of(&word, 1, &z);
  return z;
}

void normals_of(const std::uint32_t* words, std::size_t count, float* out, SimdLevel level) {
  kernel_of(level, sse2::normals_of, avx2::normals_of, avx512::normals_of)(words, count, out);
}

void rng_normals(const RngKey& key, std::uint32_t first, std::uint32_t draw, std::span<float> out) {
  std::array<std::uint32_t, 1024> words;
  for (std::size_t i = 0; i < out.size(); i += words.size()) {
    const std::size_t n = std::min(words.size(), out.size() - i);
    rng_words(key, first + std::uint32_t(i), n, draw, words.data());
    normals_of(words.data(), n, out.data() + i);
  }
}

}  // namespace dmise
