#include "core/base/files/digest.h"

#include <gtest/gtest.h>

#include <string>

#include "core/base/files/crc32c.h"

namespace dmise {
namespace {

// Reference: FIPS 180-2, appendix B, and NIST's million times 'a'.
TEST(Sha256, AgreesWithThePublishedExamples) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_hex(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// Reference: RFC 3720, appendix B.4.
TEST(Crc32c, AgreesWithThePublishedExamples) {
  std::string up;
  for (char c = 0; c < 32; ++c) up += c;
  for (const SimdLevel level : {SimdLevel::sse2, best_simd_level()}) {
    EXPECT_EQ(crc32c(std::string(32, '\0').data(), 32, 0, level), 0x8A9136AAu);
    EXPECT_EQ(crc32c(std::string(32, '\xff').data(), 32, 0, level), 0x62A8AB43u);
    EXPECT_EQ(crc32c(up.data(), 32, 0, level), 0x46DD794Eu);
  }
}

TEST(Crc32c, GoesOnOverPieces) {
  const std::string text = "a message in several pieces of odd lengths";
  const auto whole = crc32c(text.data(), text.size());
  for (const SimdLevel level : {SimdLevel::sse2, best_simd_level()})
    for (std::size_t cut = 0; cut <= text.size(); ++cut)
      EXPECT_EQ(crc32c(text.data() + cut, text.size() - cut, crc32c(text.data(), cut), level),
                whole);
}

}  // namespace
}  // namespace dmise
