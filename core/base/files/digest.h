#pragma once
#include <memory>
#include <string>
#include <string_view>

namespace dmise {

/// SHA-256 (FIPS 180-4) of `data`, 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view data);

/// SHA-256 of data that come in pieces.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void update(std::string_view piece);
  /// Call once, at the end.
  std::string hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace dmise
