#pragma once
#include <array>
#include <optional>
#include <span>

namespace dmise {

/// A measured star of the catalogue.
struct PhotometricStar {
  double instrumental_mag = 0.0;  // -2.5 log10 of electrons per second
  double sigma_mag = 0.0;
  double v_mag = 0.0, bv = 0.0;  // by the catalogue
  double airmass = 0.0;          // at its apparent altitude; 0 in space
};

/// V = zero_point + instrumental + colour_term (B-V - sunlike_bv) - extinction airmass.
struct ZeroPoint {
  static constexpr double sunlike_bv = 0.65;

  double zero_point_mag = 0.0, colour_term = 0.0, extinction_mag_per_airmass = 0.0;
  /// Covariance in this order; 0 of what was not fitted.
  std::array<std::array<double, 3>, 3> covariance{};
  bool colour_fitted = false, extinction_fitted = false;
  int stars = 0;  // without outliers
  double rms_mag = 0.0;
  /// Variance of stars besides their photons': equal for all, and by scintillation at airmass 1.
  double even_mag2 = 0.0, scintillation_mag2 = 0.0;

  double sigma(std::size_t i) const;
  /// Standard deviation of stars besides their photons'. Scintillation's variance goes as the third
  /// power of the airmass (Young 1967, AJ 72, 747).
  double scatter_mag(double airmass) const;
};

/// Fits by robust least squares (Tukey's weights), with the scatter of the residuals in the
/// covariance. The colour term takes 10 stars over 0.3 mag of B-V, else it is 0. Extinction takes
/// 20 stars over 0.25 airmasses that determine it to 0.05 mag, else it is as believed (0: unknown);
/// a belief is kept unless they determine it to 0.005 mag or contradict it by 4 sigma. Empty
/// without a star.
std::optional<ZeroPoint> fit_zero_point(std::span<const PhotometricStar> stars,
                                        std::optional<double> believed_extinction);

}  // namespace dmise
