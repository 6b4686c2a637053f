#include "core/detector/detector.h"

#include <charconv>
#include <cmath>
#include <string>

#include "core/base/error.h"

namespace dmise {
namespace {

void require(bool holds, const char* key, const char* reason, double got) {
  if (holds) return;
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, got).ptr;
  throw ConfigError(std::string("detector.") + key + ": " + reason + ", got " +
                    std::string(text, end));
}

}  // namespace

void check(const Detector& d) {
  const auto within = [](double v, double low, double high) { return v >= low && v <= high; };
  require(d.quantum_efficiency > 0.0 && d.quantum_efficiency <= 1.0, "quantum_efficiency",
          "must be in (0, 1]", d.quantum_efficiency);
  require(within(d.dark_e_per_s, 0.0, 1e9), "dark_e_per_s", "must be in 0..1e9", d.dark_e_per_s);
  require(within(d.read_noise_e, 0.0, 1e6), "read_noise_e", "must be in 0..1e6", d.read_noise_e);
  require(d.full_well_e > 0.0 && d.full_well_e <= 1e9, "full_well_e", "must be in (0, 1e9]",
          d.full_well_e);
  require(d.gain_e_per_dn > 0.0 && d.gain_e_per_dn <= 1e6, "gain_e_per_dn", "must be in (0, 1e6]",
          d.gain_e_per_dn);
  require(within(d.bias_dn, 0.0, 65535.0), "bias_dn", "must be in 0..65535", d.bias_dn);
  require(d.adc_bits >= 1 && d.adc_bits <= 16, "adc_bits", "must be 1..16", d.adc_bits);
}

}  // namespace dmise
