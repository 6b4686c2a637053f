#pragma once
namespace dmise {

/// A value with its standard deviation.
struct Measured {
  double value = 0.0, sigma = 0.0;
};

/// Electrons that the Sun itself at 1 au would give in an exposure: the factor between a flux and
/// the share of the sunlight that an object throws to the sensor, R A F / d^2. Sunlight with V =
/// `zero_point_mag` gives 1 e-/s in the band, as in the headers of frames; the Sun's spectrum (ASTM
/// E490) is in it.
double full_sunlight_e(double zero_point_mag, double exposure_s);

/// Light of an object in one band with the Sun's spectrum taken out: proportional to reflectance.
Measured reflected(const Measured& flux_e, double full_sunlight_e, double aperture_fraction);

/// Ratio of two independent measurements. The mean of a ratio is larger than the ratio of the means
/// by (sigma / value)^2 + 3 (sigma / value)^4 of the denominator; both are taken off, which leaves
/// 15 (sigma / value)^6. The standard deviation is that of the first order. Throws `Error` for a
/// denominator <= 0.
Measured flux_ratio(const Measured& numerator, const Measured& denominator);

}  // namespace dmise
