#include "core/orbit/interpolation_error.h"

#include "core/base/formatted.h"

namespace dmise {
namespace {

struct Row {
  double tick_s;
  StatedInterpolationError by_order[3];  // 3, 5, 7
};

constexpr Row measured[] = {
    {5, {{1.3e-5, 5.9e-5}, {2.5e-5, 7.5e-5}, {1.2e-5, 4.8e-5}}},
    {10, {{2.0e-4, 9.4e-4}, {5.1e-5, 5.7e-4}, {2.3e-5, 3.1e-4}}},
    {20, {{3.2e-3, 0.015}, {1.0e-4, 1.2e-3}, {4.6e-5, 1.1e-3}}},
    {30, {{0.016, 0.076}, {1.5e-4, 3.7e-3}, {6.9e-5, 2.4e-3}}},
    {60, {{0.26, 1.3}, {3.1e-4, 6.5e-3}, {1.4e-4, 4.2e-3}}},
    {120, {{4.1, 20}, {5.1e-3, 0.41}, {2.8e-4, 0.018}}},
    {180, {{21, 101}, {0.059, 4.5}, {4.6e-4, 0.20}}},
    {240, {{67, 310}, {0.34, 24}, {1.4e-3, 1.8}}},
    {300, {{164, 759}, {1.3, 86}, {7.9e-3, 9.7}}},
};
constexpr double about_a_metre = 1.3;

const StatedInterpolationError& of(const Row& row, HermiteOrder order) {
  return row.by_order[(static_cast<std::size_t>(order) - 3) / 2];
}

}  // namespace

std::optional<StatedInterpolationError> stated_interpolation_error(HermiteOrder order,
                                                                   double tick_s) {
  for (const Row& row : measured)
    if (tick_s <= row.tick_s * (1.0 + 1e-9)) return of(row, order);
  return std::nullopt;
}

std::string interpolation_text(HermiteOrder order, double tick_s) {
  const std::string of = formatted("order %d, ticks of %g s: ", static_cast<int>(order), tick_s);
  const auto error = stated_interpolation_error(order, tick_s);
  if (!error) return of + "not measured";
  return of + formatted("%.2g m median, %.2g m at worst", error->median_m, error->worst_m);
}

double longest_tick_s(HermiteOrder order) {
  double longest_s = 0.0;
  for (const Row& row : measured)
    if (of(row, order).worst_m <= about_a_metre) longest_s = row.tick_s;
  return longest_s;
}

}  // namespace dmise
