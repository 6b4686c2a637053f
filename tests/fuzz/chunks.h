#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Inputs of several parts: each after its length in two bytes. Any input is one.
namespace dmise::fuzz {

inline std::vector<std::string_view> cut(std::string_view bytes, std::size_t most = 32) {
  std::vector<std::string_view> parts;
  while (bytes.size() >= 2 && parts.size() < most) {
    const std::size_t size = std::min<std::size_t>(
        bytes.size() - 2, std::size_t(std::uint8_t(bytes[0])) << 8 | std::uint8_t(bytes[1]));
    parts.push_back(bytes.substr(2, size));
    bytes.remove_prefix(2 + size);
  }
  return parts;
}

/// The other way round: an input that `cut` takes apart into these parts.
inline void append(std::string& bytes, std::string_view part) {
  bytes += static_cast<char>(part.size() >> 8);
  bytes += static_cast<char>(part.size());
  bytes += part;
}

inline std::string_view view(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Puts `input` where a mutator wants it; false when it has no room.
inline bool place(const std::string& input, std::uint8_t* data, std::size_t* size,
                  std::size_t max_size) {
  if (input.size() > max_size) return false;
  std::copy(input.begin(), input.end(), data);
  *size = input.size();
  return true;
}

}  // namespace dmise::fuzz

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace dmise::fuzz {

/// One of the parts changed, kept in its place: lengths stay right.
inline std::size_t mutate_part(std::uint8_t* data, std::size_t size, std::size_t max_size,
                               unsigned seed) {
  const auto parts = cut(view(data, size));
  if (parts.empty()) return LLVMFuzzerMutate(data, size, max_size);
  const std::size_t which = seed % parts.size();
  std::string part(parts[which]);
  part.resize(part.size() + 64);
  part.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(part.data()), parts[which].size(),
                               part.size()));
  std::string input;
  for (std::size_t i = 0; i < parts.size(); ++i) append(input, i == which ? part : parts[i]);
  return place(input, data, &size, max_size) ? size : LLVMFuzzerMutate(data, size, max_size);
}

}  // namespace dmise::fuzz
