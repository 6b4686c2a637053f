#include "core/base/files/digest.h"

#include <sodium.h>

#include <array>

namespace dmise {

namespace {

using Hash = std::array<unsigned char, crypto_hash_sha256_BYTES>;

const unsigned char* bytes_of(std::string_view data) {
  return reinterpret_cast<const unsigned char*>(data.data());
}

std::string hex_of(const Hash& hash) {
  std::array<char, 2 * Hash().size() + 1> text;
  return sodium_bin2hex(text.data(), text.size(), hash.data(), hash.size());
}

}  // namespace

std::string sha256_hex(std::string_view data) {
  Hash hash;
  crypto_hash_sha256(hash.data(), bytes_of(data), data.size());
  return hex_of(hash);
}

struct Sha256::State {
  crypto_hash_sha256_state hash;
};

Sha256::Sha256() : state_(std::make_unique<State>()) { crypto_hash_sha256_init(&state_->hash); }

Sha256::~Sha256() = default;

void Sha256::update(std::string_view piece) {
  crypto_hash_sha256_update(&state_->hash, bytes_of(piece), piece.size());
}

std::string Sha256::hex() {
  Hash hash;
  crypto_hash_sha256_final(&state_->hash, hash.data());
  return hex_of(hash);
}

}  // namespace dmise
