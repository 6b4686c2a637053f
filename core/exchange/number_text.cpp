#include "core/exchange/number_text.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"

namespace dmise {
namespace {

void require_finite(double value) {
  if (!std::isfinite(value)) throw Error("export: a number is not finite");
}

}  // namespace

std::string fixed_text(double value, int decimals) {
  require_finite(value);
  const std::string digits = formatted("%.*f", decimals, value);
  return digits[0] == '-' && digits.find_first_not_of("-0.") == std::string::npos ? digits.substr(1)
                                                                                  : digits;
}

std::string exact_text(double value) {
  require_finite(value);
  return shortest_text(value);
}

}  // namespace dmise
