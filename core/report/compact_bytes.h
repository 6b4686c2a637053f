#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace dmise {

/// `bytes` deflated (RFC 1950, level 6) and then in base64 with padding: what a page decodes with
/// `atob` and a DecompressionStream. Equal bytes give equal text.
std::string compact(std::string_view bytes);

/// Base64 with padding (RFC 4648).
std::string base64(std::string_view bytes);

/// The first, second, third and fourth bytes (little endian) of all numbers, one after the other,
/// which deflates better.
std::string byte_planes(std::span<const std::int32_t> numbers);
std::string byte_planes(std::span<const std::uint16_t> numbers);

}  // namespace dmise
