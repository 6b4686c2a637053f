#include "sensors/alpaca/alpaca_answer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>

#include "core/base/files/json.h"

namespace dmise {
namespace {

// Numbers of the API's types of elements.
constexpr std::int32_t int32_element = 2, uint16_element = 8;
static_assert(std::endian::native == std::endian::little);

/// The members after the value.
std::string end_of_answer(const Transaction& transaction, int error, const std::string& message) {
  JsonWriter json;
  json.begin_object().field("ClientTransactionID", transaction.client);
  json.field("ServerTransactionID", transaction.server);
  json.field("ErrorNumber", error).field("ErrorMessage", message).end_object();
  return json.take().substr(1);
}

/// Copies the columns of an image one after the other, tile by tile for the caches.
void copy_columns(const CountImage& image, char* to) {
  constexpr int tile = 64;
  for (int x0 = 0; x0 < image.columns; x0 += tile)
    for (int y0 = 0; y0 < image.rows; y0 += tile)
      for (int x = x0; x < std::min(x0 + tile, image.columns); ++x)
        for (int y = y0; y < std::min(y0 + tile, image.rows); ++y)
          std::memcpy(to + 2 * (std::size_t(x) * std::size_t(image.rows) + std::size_t(y)),
                      &image.at(x, y), 2);
}

}  // namespace

std::string json_answer(const Transaction& transaction, const std::string& value) {
  return (value.empty() ? "{" : "{\"Value\":" + value + ",") + end_of_answer(transaction, 0, "");
}

std::string json_error(const Transaction& transaction, int number, const std::string& message) {
  return "{" + end_of_answer(transaction, number, message);
}

std::string json_image(const Transaction& transaction, const CountImage& image) {
  std::string text = "{\"Type\":2,\"Rank\":2,\"Value\":[";
  text.reserve(text.size() + image.pixels.size() * 6 + 1000);
  char digits[8];
  for (int x = 0; x < image.columns; ++x) {
    text += x ? ",[" : "[";
    for (int y = 0; y < image.rows; ++y) {
      const auto end = std::to_chars(digits, digits + sizeof digits, unsigned(image.at(x, y))).ptr;
      if (y) text += ',';
      text.append(digits, end);
    }
    text += ']';
  }
  return text + "]," + end_of_answer(transaction, 0, "");
}

std::string image_bytes(const Transaction& transaction, const CountImage& image) {
  constexpr std::int32_t version = 1, no_error = 0, rank = 2, no_dimension = 0;
  const std::array<std::int32_t, 11> metadata{version,
                                              no_error,
                                              std::bit_cast<std::int32_t>(transaction.client),
                                              std::bit_cast<std::int32_t>(transaction.server),
                                              std::int32_t(sizeof(std::int32_t) * 11),
                                              int32_element,
                                              uint16_element,
                                              rank,
                                              image.columns,
                                              image.rows,
                                              no_dimension};
  std::string bytes(sizeof metadata + 2 * image.pixels.size(), '\0');
  std::memcpy(bytes.data(), metadata.data(), sizeof metadata);
  copy_columns(image, bytes.data() + sizeof metadata);
  return bytes;
}

}  // namespace dmise
