#include "nodes/wire/field_rules.h"

#include <cstdint>
#include <limits>

#include "nodes/wire/envelope.h"

namespace dmise::field_rules {

void refuse(const std::string& field, const std::string& reason) {
  throw Refused(Refusal::value, field + ": " + reason);
}

void finite(double value, const char* field) {
  if (!std::isfinite(value)) refuse(field, "must be finite");
}

void in_range(double value, double low, double high, const char* field) {
  if (!(value >= low && value <= high))
    refuse(field, "must be in [" + std::to_string(low) + ", " + std::to_string(high) + "], got " +
                      std::to_string(value));
}

void not_negative(double value, const char* field) {
  in_range(value, 0.0, std::numeric_limits<double>::max(), field);
}

void direction(double ra_rad, double dec_rad, const char* field) {
  in_range(ra_rad, -angle_limit_rad, angle_limit_rad, field);
  in_range(dec_rad, -latitude_limit_rad, latitude_limit_rad, field);
}

void covariance(const std::array<double, 3>& c, const char* field) {
  for (const double value : c) finite(value, field);
  if (c[0] < 0 || c[2] < 0 || c[1] * c[1] > c[0] * c[2] * (1 + 1e-9))
    refuse(field, "must be positive semi-definite");
}

void utf8(const std::string& text, std::size_t limit, const char* field) {
  if (text.size() > limit) refuse(field, "longer than " + std::to_string(limit) + " bytes");
  const auto* p = reinterpret_cast<const unsigned char*>(text.data());
  const auto* end = p + text.size();
  while (p < end) {
    const int more = *p < 0x80 ? 0 : *p >> 5 == 6 ? 1 : *p >> 4 == 14 ? 2 : *p >> 3 == 30 ? 3 : -1;
    if (more < 0 || end - p <= more) refuse(field, "must be UTF-8");
    std::uint32_t code = more == 0 ? *p : *p & (0x3fu >> more);
    for (int i = 1; i <= more; ++i) {
      if (p[i] >> 6 != 2) refuse(field, "must be UTF-8");
      code = code << 6 | (p[i] & 0x3fu);
    }
    constexpr std::uint32_t smallest[] = {0, 0x80, 0x800, 0x10000};
    if (code < smallest[more] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000))
      refuse(field, "must be UTF-8");
    p += more + 1;
  }
}

void name_text(const std::string& text, const char* field) {
  constexpr std::size_t limit_bytes = 256;
  utf8(text, limit_bytes, field);
}

}  // namespace dmise::field_rules
