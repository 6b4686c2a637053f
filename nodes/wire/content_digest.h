#pragma once
#include <cstdint>
#include <string_view>

#include "core/base/crc32c.h"
#include "core/base/fold_digest.h"
#include "nodes/wire/envelope.h"

namespace dmise {

/// Adds one message to the digest of its topic and tick: content only, independent of sender and
/// time.
inline std::uint64_t fold_content(std::uint64_t digest, MessageKind kind, std::string_view payload,
                                  std::string_view arrays) {
  const auto crc = [](std::string_view bytes) {
    return std::uint64_t(crc32c(bytes.data(), bytes.size())) << 32 ^ bytes.size();
  };
  digest = fold_digest(digest, std::uint64_t(kind));
  return fold_digest(fold_digest(digest, crc(payload)), crc(arrays));
}

}  // namespace dmise
