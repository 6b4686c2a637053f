#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace dmise::test {

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

struct DeepStar {
  int ra_1e6h = 1'000'000, dec_1e5deg = 0, pm_ra = 0, pm_dec = 0;
  std::int16_t vt = 900, bt_vt = 0;
};

/// A file of one trixel, as the layout at the head of core/sky/stars/star_file_deep.cpp says.
inline std::string deep_file(const std::vector<DeepStar>& stars) {
  std::string bytes = "KStars Star Data v1.0. To be read using the 32-bit starData structure only.";
  bytes.resize(124);
  put(bytes, std::int16_t(0x4B53)), put(bytes, std::int8_t(1)), put(bytes, std::int16_t(11));
  const auto field = [&](const char* name, int size, int scale) {
    std::array<char, 10> padded{};
    std::memcpy(padded.data(), name, std::strlen(name));
    put(bytes, padded), put(bytes, std::int8_t(size)), put(bytes, std::int8_t(0)),
        put(bytes, scale);
  };
  field("RA", 4, 1000000), field("Dec", 4, 100000), field("dRA", 4, 10), field("dDec", 4, 10);
  field("parallax", 4, 10), field("HD", 4, 10), field("mag", 2, 100), field("bv_index", 2, 100);
  field("spec_type", 2, 0), field("flags", 1, 0), field("unused", 1, 100);
  put(bytes, 1), put(bytes, 0), put(bytes, int(bytes.size()) + 4 + 4 + 5);
  put(bytes, int(stars.size()));
  put(bytes, std::int16_t(1519)), put(bytes, std::int8_t(3)), put(bytes, std::int16_t(100));
  for (const DeepStar& s : stars) {
    put(bytes, s.ra_1e6h), put(bytes, s.dec_1e5deg), put(bytes, s.pm_ra), put(bytes, s.pm_dec);
    put(bytes, 12345), put(bytes, 0), put(bytes, s.vt), put(bytes, s.bt_vt), put(bytes, 0);
  }
  return bytes;
}

}  // namespace dmise::test
