#include "core/instrument/vibration.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/instrument/instrument.h"

namespace dmise {
namespace {

constexpr double max_hz = 1e5, max_arcsec = 36000.0;

double sinc(double x) { return std::abs(x) < 1e-8 ? 1.0 : std::sin(x) / x; }

/// Share of the power at a frequency that displaces an exposure.
double displacing(double frequency_hz, double exposure_s) {
  const double s = sinc(pi * frequency_hz * exposure_s);
  return s * s;
}

}  // namespace

std::span<const InstrumentParameter> Vibration::parameters() {
  using Kind = InstrumentParameter::Kind;
  static const InstrumentParameter table[] = {
      {"psd_hz", 1.0, max_hz, Kind::list, &Vibration::psd_frequency_hz,
       "Frequencies of the power spectral density [Hz], rising."},
      {"psd_arcsec2_per_hz", arcsec * arcsec, max_arcsec * max_arcsec, Kind::list,
       &Vibration::psd_rad2_per_hz,
       "One-sided density of an axis there [arcsec2/Hz]; straight between, none outside."},
      {"sine_hz", 1.0, max_hz, Kind::list, &Vibration::sine_frequency_hz,
       "Frequencies of sinusoids [Hz]."},
      {"sine_rms_arcsec", arcsec, max_arcsec, Kind::list, &Vibration::sine_rms_rad,
       "Their rms along an axis [arcsec]."}};
  return table;
}

std::string_view Vibration::fault() const {
  if (psd_frequency_hz.size() != psd_rad2_per_hz.size())
    return "psd_hz and psd_arcsec2_per_hz must have the same number of items";
  if (psd_frequency_hz.size() == 1) return "psd_hz must have two frequencies or more";
  if (sine_frequency_hz.size() != sine_rms_rad.size())
    return "sine_hz and sine_rms_arcsec must have the same number of items";
  for (std::size_t k = 1; k < psd_frequency_hz.size(); ++k)
    if (psd_frequency_hz[k] <= psd_frequency_hz[k - 1]) return "psd_hz must rise";
  return "";
}

double Vibration::power_rad2(double exposure_s, bool of_blur) const {
  const auto share = [&](double f) {
    const double shift = displacing(f, exposure_s);
    return of_blur ? 1.0 - shift : shift;
  };
  double power = 0.0;
  for (std::size_t k = 0; k < sine_frequency_hz.size(); ++k)
    power += sine_rms_rad[k] * sine_rms_rad[k] * share(sine_frequency_hz[k]);
  for (std::size_t k = 1; k < psd_frequency_hz.size(); ++k) {
    const double from = psd_frequency_hz[k - 1], width = psd_frequency_hz[k] - from;
    const double first = psd_rad2_per_hz[k - 1], rise = psd_rad2_per_hz[k] - first;
    // Sixteen steps for each zero of the share.
    const int steps = int(std::clamp(16.0 * width * exposure_s, 64.0, 1e5));
    for (int i = 0; i < steps; ++i) {
      const double at = (i + 0.5) / steps;
      power += (first + rise * at) * share(from + width * at) * width / steps;
    }
  }
  return power;
}

double Vibration::shift_rms_rad(double exposure_s) const {
  return std::sqrt(power_rad2(exposure_s, false));
}

double Vibration::blur_rad(double exposure_s) const {
  return std::sqrt(power_rad2(exposure_s, true));
}

ImageAxes Vibration::shift_rad(const RngKey& key, SimTime middle, double exposure_s) const {
  ImageAxes shift{};
  std::uint32_t wave = 0;
  const auto add = [&](double frequency_hz, double power_rad2) {
    const double mean = std::sqrt(2.0 * power_rad2) * sinc(pi * frequency_hz * exposure_s);
    const double turns = frequency_hz * middle.seconds();
    for (std::uint32_t axis = 0; axis < 2; ++axis)
      shift[axis] +=
          mean *
          std::cos(2.0 * pi * (turns - std::floor(turns) + uniform_of(rng_word(key, wave, axis))));
    ++wave;
  };
  for (std::size_t k = 0; k < sine_frequency_hz.size(); ++k)
    add(sine_frequency_hz[k], sine_rms_rad[k] * sine_rms_rad[k]);
  // The density in waves of one frequency each, at random within its part, even in the logarithm.
  constexpr int parts = 64;
  for (std::size_t k = 1; k < psd_frequency_hz.size(); ++k) {
    const double from = psd_frequency_hz[k - 1], to = psd_frequency_hz[k], width = to - from;
    const double first = psd_rad2_per_hz[k - 1], rise = psd_rad2_per_hz[k] - first;
    const auto edge = [&](int i) {
      return from > 0.0 ? from * std::pow(to / from, double(i) / parts) : to * i / parts;
    };
    for (int i = 0; i < parts; ++i) {
      const double low = edge(i), high = edge(i + 1), middle_hz = 0.5 * (low + high);
      const double frequency_hz = low + (high - low) * uniform_of(rng_word(key, wave, 2));
      add(frequency_hz, (first + rise * (middle_hz - from) / width) * (high - low));
    }
  }
  return shift;
}

}  // namespace dmise
