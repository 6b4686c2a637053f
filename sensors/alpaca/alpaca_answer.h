#pragma once
#include <cstdint>
#include <string>

#include "core/base/image.h"

// Answers of the Alpaca API, version 1.
namespace dmise {

struct Transaction {
  std::uint32_t client = 0, server = 0;
};

/// The answer to a call: a JSON value, or none.
std::string json_answer(const Transaction& transaction, const std::string& value);
/// The answer to a call that a device refuses.
std::string json_error(const Transaction& transaction, int number, const std::string& message);
/// An image as arrays of columns, each from its first row down.
std::string json_image(const Transaction& transaction, const CountImage& image);
/// An image as bytes (application/imagebytes, metadata version 1): 32-bit numbers, which are sent
/// as UInt16; the columns one after the other.
std::string image_bytes(const Transaction& transaction, const CountImage& image);

}  // namespace dmise
