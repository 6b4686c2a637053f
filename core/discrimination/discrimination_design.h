#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core/discrimination/material_likelihood.h"
#include "core/optics/camera.h"

namespace dmise {

/// What determines the noise of a camera in orbit within an aperture.
struct SpectralImager {
  Optics optics;
  double quantum_efficiency = 1.0;
  double dark_e_per_s = 0.0, read_noise_e = 0.0;
  double sky_v_mag_per_arcsec2 = 21.0;  // sunlight: the zodiacal light
  double aperture_px = 4.0;             // radius of the photometric aperture
};

/// The object that it observes.
struct ReflectingTarget {
  // Times the phase function: the sunlight to the sensor per steradian if the reflectance is 1.
  double area_m2 = 1.0;
  double range_m = 2.4e6;
};

/// Light of an object that reflects everything, and noise of the light, in one band.
struct ExpectedBand {
  double sunlight_e = 0.0;     // in the aperture, of reflectance 1
  double background_e2 = 0.0;  // variance in the aperture without the object's own light
};

ExpectedBand expected_band(const SpectralImager& imager, const ReflectingTarget& target,
                           const Band& band, double exposure_s);

/// Probability that the worse recognised of two materials is taken for the other in one exposure of
/// each band; with the Poisson noise of the material's own light.
double wrong_probability(const SpectralImager& imager, const ReflectingTarget& target,
                         const std::array<Band, 2>& bands, const std::array<Material, 2>& materials,
                         double exposure_s);

/// Shortest exposure of each band [s] at which that is at most `wrong`; empty if more than 1e5 s.
std::optional<double> exposure_for(const SpectralImager& imager, const ReflectingTarget& target,
                                   const std::array<Band, 2>& bands,
                                   const std::array<Material, 2>& materials, double wrong = 0.01);

/// Two bands, and the exposure that they need.
struct BandPair {
  Band shorter, longer;
  std::optional<double> exposure_s;
};

/// All pairs of bands of `width_m` that lie side by side from `low_m` to `high_m`, best first.
std::vector<BandPair> compare_band_pairs(const SpectralImager& imager,
                                         const ReflectingTarget& target,
                                         const std::array<Material, 2>& materials, double low_m,
                                         double high_m, double width_m, double wrong = 0.01);

/// A point of a design curve: a value of what is varied, and the exposure that it needs.
struct DesignPoint {
  double value = 0.0;
  std::optional<double> exposure_s;
};

/// The answer to which bands, exposure, aperture and distance tell two materials apart.
struct DiscriminationDesign {
  std::array<Band, 2> bands;
  std::array<Material, 2> materials;
  double right = 0.99;
  std::vector<std::array<double, 2>> right_by_exposure;  // s, probability of the right material
  std::vector<DesignPoint> by_range_m, by_aperture_m, by_photometric_radius_px;
  std::vector<BandPair> pairs;  // 0.40 to 1.80 um, 50 nm wide
};

/// `by_aperture_m` keeps the focal length.
DiscriminationDesign design(const SpectralImager& imager, const ReflectingTarget& target,
                            const std::array<Band, 2>& bands,
                            const std::array<Material, 2>& materials, double right = 0.99);

}  // namespace dmise
