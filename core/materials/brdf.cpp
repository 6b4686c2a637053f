#include "core/materials/brdf.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

double reflectance(const Lambert& m, double) { return m.reflectance; }

double reflectance(const SandfordRobertson& m, double cos_in) {
  return 1.0 - m.emissivity * sandford_robertson_falloff(cos_in, m.grazing) /
                   sandford_robertson_mean(m.grazing);
}

/// Integrates the lobe about the mirror direction, in polar angle from it (cos^(n+1) = w^2, so that
/// the lobe is nearly uniform) and azimuth.
double reflectance(const Phong& m, double cos_in) {
  constexpr int steps = 400;
  const double sin_in = std::sqrt(std::max(0.0, 1.0 - cos_in * cos_in));
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double w = (i + 0.5) / steps;
    const double c = std::pow(w, 2.0 / (m.exponent + 1.0));
    const double a = c * cos_in, b = std::sqrt(std::max(0.0, 1.0 - c * c)) * sin_in;
    // Mean over azimuth of max(0, a + b cos).
    if (a >= b) {
      sum += 2.0 * w * a;
    } else {
      const double edge = std::acos(std::clamp(-a / b, -1.0, 1.0));
      sum += 2.0 * w * (a * edge + b * std::sin(edge)) / pi;
    }
  }
  return m.diffuse + m.specular * (m.exponent + 2.0) / (m.exponent + 1.0) * sum / steps;
}

std::string format_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

void require(bool holds, std::string_view name, const char* reason, double value) {
  if (!holds) throw Error(std::string(name) + ": " + reason + ", got " + format_number(value));
}

void check(const Lambert& m, std::string_view name) {
  require(m.reflectance >= 0.0 && m.reflectance <= 1.0, name, "reflectance must be in [0, 1]",
          m.reflectance);
}

void check(const SandfordRobertson& m, std::string_view name) {
  require(m.grazing >= 0.0 && m.grazing <= 10.0, name, "grazing must be in [0, 10]", m.grazing);
  require(m.lobe_width >= 1e-3 && m.lobe_width <= 1.0, name, "lobe_width must be in [0.001, 1]",
          m.lobe_width);
  require(m.emissivity >= 0.0, name, "emissivity must be >= 0", m.emissivity);
  require(m.diffuse >= 0.0, name, "diffuse must be >= 0", m.diffuse);
  const double most = sandford_robertson_mean(m.grazing);
  require(m.emissivity + m.diffuse <= most * (1 + 1e-12), name,
          ("emissivity + diffuse must be <= G(grazing) = " + format_number(most)).c_str(),
          m.emissivity + m.diffuse);
}

void check(const Phong& m, std::string_view name) {
  require(m.diffuse >= 0.0, name, "diffuse must be >= 0", m.diffuse);
  require(m.specular >= 0.0, name, "specular must be >= 0", m.specular);
  require(m.diffuse + m.specular <= 1.0 + 1e-12, name, "diffuse + specular must be <= 1",
          m.diffuse + m.specular);
  require(m.exponent >= 0.0 && m.exponent <= 1e5, name, "exponent must be in [0, 1e5]", m.exponent);
}

}  // namespace

double directional_reflectance(const Brdf& brdf, double cos_in) {
  const double c = std::clamp(cos_in, 0.0, 1.0);
  return std::visit([&](const auto& model) { return reflectance(model, c); }, brdf);
}

void check_brdf(const Brdf& brdf, std::string_view name) {
  std::visit([&](const auto& model) { check(model, name); }, brdf);
}

double sandford_robertson_falloff(double cos_angle, double grazing) {
  const double c2 = cos_angle * cos_angle;
  const double denominator = c2 + grazing * grazing * (1.0 - c2);
  return denominator > 0.0 ? std::min(1.0, c2 / denominator) : 1.0;
}

double sandford_robertson_mean(double grazing) {
  const double b2 = grazing * grazing;
  if (b2 == 0.0) return 1.0;
  const double x = 1.0 - b2;
  if (std::abs(x) > 0.2) return (1.0 + b2 / x * std::log(b2)) / x;
  // The closed form is 0/0 at b = 1; near it, the series sum of x^k / ((k + 1) (k + 2)).
  double sum = 0.0, power = 1.0;
  for (int k = 0; k < 24; ++k, power *= x) sum += power / ((k + 1.0) * (k + 2.0));
  return sum;
}

double sandford_robertson_lobe_norm(double cos_in, double lobe_width) {
  const double e2 = lobe_width * lobe_width, d = 1.0 - e2, c = cos_in;
  return (d * c + (2.0 * e2 + d * d * c * c) / std::sqrt(d * d * c * c + 4.0 * e2)) / (2.0 * e2);
}

}  // namespace dmise
