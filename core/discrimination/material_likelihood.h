#pragma once
#include <span>
#include <string>
#include <vector>

#include "core/discrimination/spectral_signature.h"
#include "core/materials/material.h"
#include "core/photometry/band.h"

namespace dmise {

/// Reflectance of a material in each of some bands, for the Sun's photons at normal incidence.
struct MaterialSignature {
  std::string name;
  std::vector<double> reflectance;
};

MaterialSignature signature_of(const Material& material, std::span<const Band> bands);

/// How well one material explains what was measured.
struct MaterialFit {
  std::string name;
  double amplitude = 0.0;    // area times geometry, >= 0: what was measured over the reflectance
  double chi2 = 0.0;         // with as many degrees of freedom as bands less one
  double probability = 0.0;  // among the materials of the list, each as likely before
};

/// Fits each material's reflectances to light in the same bands (`reflected`), the amplitude free
/// but not negative, and compares their likelihoods. In order of probability, ties in that of the
/// list. Throws `Error` for no materials, and for numbers of bands that differ.
std::vector<MaterialFit> compare_materials(std::span<const Measured> light,
                                           std::span<const MaterialSignature> materials);

/// How often what is `actual` was found to be `found`.
class ConfusionMatrix {
 public:
  explicit ConfusionMatrix(std::vector<std::string> names);

  /// Throws `Error` for a name that is not in the list.
  void add(const std::string& actual, const std::string& found);
  const std::vector<std::string>& names() const { return names_; }
  std::size_t count(std::size_t actual, std::size_t found) const {
    return counts_[actual * names_.size() + found];
  }
  std::size_t total(std::size_t actual) const;
  /// Share of all that is right; 0 of none.
  double accuracy() const;

 private:
  std::size_t index(const std::string& name) const;
  std::vector<std::string> names_;
  std::vector<std::size_t> counts_;
};

/// Probability that light of `actual` is taken for `other` (compare_materials, two bands), when
/// each band has Gaussian noise. `amplitude` times reflectance is the expected light. Closed form;
/// what falls opposite to both is left out. 0.5 for equal ratios.
double mistaken_probability(const MaterialSignature& actual, const MaterialSignature& other,
                            double amplitude, std::span<const double> sigma);

}  // namespace dmise
