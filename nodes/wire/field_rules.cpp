#include "nodes/wire/field_rules.h"

#include <limits>

#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "nodes/wire/refusal.h"

namespace dmise::field_rules {

void refuse(const std::string& field, const std::string& reason) {
  throw Refused(Refusal::value, field + ": " + reason);
}

void finite(double value, const char* field) {
  if (!std::isfinite(value)) refuse(field, "must be finite");
}

void in_range(double value, double low, double high, const char* field) {
  if (!(value >= low && value <= high))
    refuse(field, formatted("must be in [%.9g, %.9g], got %.9g", low, high, value));
}

void not_negative(double value, const char* field) {
  in_range(value, 0.0, std::numeric_limits<double>::max(), field);
}

void direction(double ra_rad, double dec_rad, const char* field) {
  in_range(ra_rad, -angle_limit_rad, angle_limit_rad, field);
  in_range(dec_rad, -latitude_limit_rad, latitude_limit_rad, field);
}

void all_within(std::span<const double> values, double limit, const char* field) {
  for (const double value : values) in_range(value, -limit, limit, field);
}

void covariance(const std::array<double, 3>& c, const char* field) {
  for (const double value : c) finite(value, field);
  if (c[0] < 0 || c[2] < 0 || c[1] * c[1] > c[0] * c[2] * (1 + 1e-9))
    refuse(field, "must be positive semi-definite");
}

void covariance(const std::array<double, 21>& c, const char* field) {
  for (std::size_t row = 0, k = 0; row < 6; ++row)
    for (std::size_t column = 0; column <= row; ++column, ++k) {
      finite(c[k], field);
      if (row == column) not_negative(c[k], field);
    }
}

void utf8(const std::string& text, std::size_t limit, const char* field) {
  if (text.size() > limit) refuse(field, "longer than " + std::to_string(limit) + " bytes");
  if (!is_utf8(text)) refuse(field, "must be UTF-8");
}

void name_text(const std::string& text, const char* field) {
  constexpr std::size_t limit_bytes = 256;
  utf8(text, limit_bytes, field);
}

}  // namespace dmise::field_rules
