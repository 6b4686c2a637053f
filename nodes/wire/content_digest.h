#pragma once
#include <cstdint>
#include <string_view>

#include "core/base/files/crc32c.h"
#include "core/base/files/fold_digest.h"
#include "nodes/wire/envelope.h"

namespace dmise {

/// Returns the digest of the content of a message, independent of its sender and time.
inline std::uint64_t content_digest(MessageKind kind, std::string_view payload,
                                    std::string_view arrays) {
  const auto crc = [](std::string_view bytes) {
    return std::uint64_t(crc32c(bytes.data(), bytes.size())) << 32 ^ bytes.size();
  };
  const std::uint64_t digest = fold_digest(0, std::uint64_t(kind));
  return fold_digest(fold_digest(digest, crc(payload)), crc(arrays));
}

}  // namespace dmise
