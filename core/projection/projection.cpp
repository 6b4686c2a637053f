#include "core/projection/projection.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/formatted.h"

namespace dmise {
namespace {

using Model = Projection::Model;

template <std::size_t... Index>
constexpr auto table(std::index_sequence<Index...>) {
  return std::array{Projection::Row{std::variant_alternative_t<Index, Model>::name,
                                    std::variant_alternative_t<Index, Model>::fits_code,
                                    std::variant_alternative_t<Index, Model>::coefficients,
                                    std::variant_alternative_t<Index, Model>::widest_field_rad}...};
}

using Rows = std::make_index_sequence<std::variant_size_v<Model>>;
constexpr auto all_rows = table(Rows());

template <class Lens>
Model with(std::span<const double> values) {
  if constexpr (Lens::coefficients.empty()) {
    return Lens{};
  } else {
    std::array<double, Lens::coefficients.size()> all;
    std::copy(values.begin(), values.end(), all.begin());
    return Lens(all);
  }
}

template <std::size_t... Index>
Model model_of(std::size_t index, std::span<const double> values, std::index_sequence<Index...>) {
  constexpr std::array makers{&with<std::variant_alternative_t<Index, Model>>...};
  return makers[index](values);
}

void require(const ProjectionCoefficient& c, double value) {
  if (std::abs(value) <= c.most) return;
  throw Error(std::string(c.key) + ": must be in " + shortest_text(-c.most) + ".." +
              shortest_text(c.most) + ", got " + shortest_text(value));
}

}  // namespace

std::span<const Projection::Row> Projection::rows() { return all_rows; }

std::optional<std::size_t> Projection::index_of_name(std::string_view name) {
  for (std::size_t i = 0; i < all_rows.size(); ++i)
    if (name == all_rows[i].name) return i;
  return std::nullopt;
}

std::optional<std::size_t> Projection::index_of_fits_code(std::string_view code) {
  for (std::size_t i = 0; i < all_rows.size(); ++i)
    if (all_rows[i].fits_code && code == all_rows[i].fits_code) return i;
  return std::nullopt;
}

Projection Projection::make(std::size_t index, std::span<const double> coefficients) {
  if (index >= all_rows.size()) throw Error("projection: unknown");
  const auto wanted = all_rows[index].coefficients;
  if (coefficients.size() != wanted.size())
    throw Error("coefficients: " + std::string(all_rows[index].name) + " has " +
                std::to_string(wanted.size()) + ", got " + std::to_string(coefficients.size()));
  for (std::size_t i = 0; i < wanted.size(); ++i) require(wanted[i], coefficients[i]);
  return model_of(index, coefficients, Rows());
}

std::span<const double> Projection::coefficients() const {
  return std::visit(
      []<class Lens>(const Lens& lens) -> std::span<const double> {
        if constexpr (Lens::coefficients.empty())
          return {};
        else
          return lens.values();
      },
      model_);
}

double Projection::height(double theta_rad) const {
  return std::visit([&](const auto& lens) { return lens.height(theta_rad); }, model_);
}

double Projection::rim() const {
  return std::visit([](const auto& lens) { return lens.rim(); }, model_);
}

std::optional<double> Projection::fold_rad() const {
  return std::visit([](const auto& lens) { return lens.fold_rad(); }, model_);
}

std::optional<double> Projection::axis_angle_rad(double x, double y) const {
  return std::visit([&](const auto& lens) { return lens.axis_angle_rad(x, y); }, model_);
}

std::optional<std::array<double, 3>> Projection::direction_of(double x, double y) const {
  return std::visit([&](const auto& lens) { return lens.direction_of(x, y); }, model_);
}

std::optional<std::array<double, 2>> Projection::image_of(double x, double y, double z) const {
  return std::visit([&](const auto& lens) { return lens.image_of(x, y, z); }, model_);
}

double Projection::pixel_solid_angle_sr(double x_px, double y_px, double focal_length_px) const {
  return std::visit(
      [&](const auto& lens) { return lens.pixel_solid_angle_sr(x_px, y_px, focal_length_px); },
      model_);
}

}  // namespace dmise
