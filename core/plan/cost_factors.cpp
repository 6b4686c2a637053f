#include "core/plan/cost_factors.h"

#include <sstream>

#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/base/files/user_directories.h"
#include "core/base/formatted.h"

namespace dmise {
std::string cost_factors_path() {
  const std::string directory = cache_directory();
  return directory.empty() ? "" : directory + "/cost-factors.txt";
}

CostFactors load_cost_factors(const std::string& path) {
  constexpr double largest_factor = 1e6;
  CostFactors factors;
  if (!path_exists(path)) return factors;
  std::istringstream lines(read_text_file(path, 1u << 20));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string name, rest;
    double factor = 0.0;
    if (!(words >> name >> factor) || words >> rest || !(factor > 0.0) || factor > largest_factor)
      throw ConfigError(path + ":" + std::to_string(number) +
                        ": must be NAME FACTOR with a factor in (0, 1e6], got " + line);
    factors[name] = factor;
  }
  return factors;
}

std::string cost_factors_text(const CostFactors& factors) {
  std::string text =
      "# Written by dmise bench calibrate: cost of effects on this machine over the shipped "
      "table.\n";
  for (const auto& [name, factor] : factors) text += formatted("%s %.4g\n", name.c_str(), factor);
  return text;
}

double predicted_s(const PlannedEffect& effect, const CostFactors& factors) {
  const auto found = factors.find(effect.facts->name);
  return effect.cost_s * (found == factors.end() ? 1.0 : found->second);
}

double predicted_s(const EffectPlan& plan, const CostFactors& factors) {
  double sum = 0.0;
  for (const auto& effect : plan.planned) sum += predicted_s(effect, factors);
  return sum;
}

}  // namespace dmise
