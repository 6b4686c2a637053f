#include "core/discrimination/material_likelihood.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace dmise {

MaterialSignature signature_of(const Material& material, std::span<const Band> bands) {
  MaterialSignature signature{material.name, {}};
  for (const Band& band : bands)
    signature.reflectance.push_back(directional_reflectance(brdf_in_band(material, band), 1.0));
  return signature;
}

std::vector<MaterialFit> compare_materials(std::span<const Measured> light,
                                           std::span<const MaterialSignature> materials) {
  if (materials.empty()) throw Error("materials: there are none to compare");
  std::vector<MaterialFit> fits;
  double least = 0.0;
  for (const MaterialSignature& m : materials) {
    if (m.reflectance.size() != light.size())
      throw Error("material " + m.name + ": has " + std::to_string(m.reflectance.size()) +
                  " bands, got light in " + std::to_string(light.size()));
    double product = 0.0, square = 0.0, all = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double weight = 1.0 / (light[i].sigma * light[i].sigma);
      product += weight * light[i].value * m.reflectance[i];
      square += weight * m.reflectance[i] * m.reflectance[i];
      all += weight * light[i].value * light[i].value;
    }
    const double amplitude = square > 0.0 ? std::max(0.0, product / square) : 0.0;
    fits.push_back({m.name, amplitude, std::max(0.0, all - amplitude * product), 0.0});
    least = fits.size() == 1 ? fits.back().chi2 : std::min(least, fits.back().chi2);
  }
  double sum = 0.0;
  for (MaterialFit& fit : fits) sum += fit.probability = std::exp(-0.5 * (fit.chi2 - least));
  for (MaterialFit& fit : fits) fit.probability /= sum;
  std::stable_sort(fits.begin(), fits.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  return fits;
}

ConfusionMatrix::ConfusionMatrix(std::vector<std::string> names)
    : names_(std::move(names)), counts_(names_.size() * names_.size()) {}

std::size_t ConfusionMatrix::index(const std::string& name) const {
  const auto at = std::find(names_.begin(), names_.end(), name);
  if (at == names_.end()) throw Error("confusion matrix: no such material: " + name);
  return std::size_t(at - names_.begin());
}

void ConfusionMatrix::add(const std::string& actual, const std::string& found) {
  ++counts_[index(actual) * names_.size() + index(found)];
}

std::size_t ConfusionMatrix::total(std::size_t actual) const {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < names_.size(); ++i) sum += count(actual, i);
  return sum;
}

double ConfusionMatrix::accuracy() const {
  std::size_t right = 0, all = 0;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    right += count(i, i);
    all += total(i);
  }
  return all > 0 ? double(right) / double(all) : 0.0;
}

double mistaken_probability(const MaterialSignature& actual, const MaterialSignature& other,
                            double amplitude, std::span<const double> sigma) {
  if (actual.reflectance.size() != 2 || other.reflectance.size() != 2 || sigma.size() != 2)
    throw Error("mistaken probability: is of two bands");
  // In units of the noise a material is a direction of the plane, and light goes to the nearer.
  const auto direction = [&](const MaterialSignature& m) {
    return std::atan2(m.reflectance[1] / sigma[1], m.reflectance[0] / sigma[0]);
  };
  const double snr =
      amplitude * std::hypot(actual.reflectance[0] / sigma[0], actual.reflectance[1] / sigma[1]);
  const double half = 0.5 * std::abs(direction(actual) - direction(other));
  return 0.5 * std::erfc(snr * std::sin(half) / std::sqrt(2.0));
}

}  // namespace dmise
