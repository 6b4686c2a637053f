#include "core/exchange/number_text.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"

namespace dmise {

std::string fixed_text(double value, int decimals) {
  if (!std::isfinite(value)) throw Error("export: a number is not finite");
  const std::string digits = formatted("%.*f", decimals, value);
  return digits[0] == '-' && digits.find_first_not_of("-0.") == std::string::npos ? digits.substr(1)
                                                                                  : digits;
}

}  // namespace dmise
