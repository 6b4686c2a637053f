#include "core/plan/knapsack.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dmise {
namespace {

constexpr std::size_t kinds = std::size(error_kinds);
using Shares = std::array<double, kinds>;  // parts of the budget

constexpr int steps = 60;
/// Allows for the rounding of a sum of shares that is one.
constexpr double slack = 1e-12;

struct Option {
  Shares share{};
  double cost_s = 0.0;
  std::size_t index = 0;  // as given
};

bool is_no_worse(const Option& a, const Option& b) {
  if (a.cost_s > b.cost_s) return false;
  for (std::size_t k = 0; k < kinds; ++k)
    if (a.share[k] > b.share[k]) return false;
  return true;
}

/// The options that can be in an optimum: those within the budget to which no other is equal or
/// better in everything. Among equals the first, which does the least.
std::vector<Option> useful(const KnapsackChoice& choice, const ErrorBound& budget) {
  std::vector<Option> options;
  for (std::size_t i = 0; i < choice.size(); ++i) {
    Option option{.cost_s = choice[i].cost_s, .index = i};
    bool possible = true;
    for (std::size_t k = 0; k < kinds; ++k) {
      const double error = choice[i].error.*error_kinds[k].value;
      const double most = budget.*error_kinds[k].value;
      if (error > most) possible = false;
      option.share[k] = error > 0.0 && std::isfinite(most) && possible ? error / most : 0.0;
    }
    if (!possible) continue;
    if (std::any_of(options.begin(), options.end(),
                    [&](const Option& other) { return is_no_worse(other, option); }))
      continue;
    std::erase_if(options, [&](const Option& other) { return is_no_worse(option, other); });
    options.push_back(option);
  }
  return options;
}

/// A selection with its sums.
class Selection {
 public:
  explicit Selection(const std::vector<std::vector<Option>>& choices)
      : choices_(choices), taken_(choices.size(), 0) {
    for (std::size_t i = 0; i < choices.size(); ++i) add(choices[i][0], 1.0);
  }

  const Option& at(std::size_t choice) const { return choices_[choice][taken_[choice]]; }
  std::size_t taken(std::size_t choice) const { return taken_[choice]; }
  double cost_s() const { return cost_s_; }
  const Shares& share() const { return share_; }
  bool fits() const {
    return std::all_of(share_.begin(), share_.end(), [](double s) { return s <= 1.0 + slack; });
  }
  void take(std::size_t choice, std::size_t option) {
    add(at(choice), -1.0);
    taken_[choice] = option;
    add(at(choice), 1.0);
  }
  /// Whether it would fit with other options.
  bool would_fit(const Option& less, const Option& more) const {
    for (std::size_t k = 0; k < kinds; ++k)
      if (share_[k] - less.share[k] + more.share[k] > 1.0 + slack) return false;
    return true;
  }

 private:
  void add(const Option& option, double sign) {
    cost_s_ += sign * option.cost_s;
    for (std::size_t k = 0; k < kinds; ++k) share_[k] += sign * option.share[k];
  }
  const std::vector<std::vector<Option>>& choices_;
  std::vector<std::size_t> taken_;
  Shares share_{};
  double cost_s_ = 0.0;
};

/// Takes other options until all fit into the budget, each time at the lowest cost for what is over
/// it.
void repair(Selection& s, const std::vector<std::vector<Option>>& choices) {
  while (!s.fits()) {
    double best = unbounded;
    std::size_t which = 0, option = 0;
    for (std::size_t i = 0; i < choices.size(); ++i)
      for (std::size_t j = 0; j < choices[i].size(); ++j) {
        double relief = 0.0;  // how much less is over the budget
        for (std::size_t k = 0; k < kinds; ++k) {
          const double now = s.share()[k];
          const double then = now - s.at(i).share[k] + choices[i][j].share[k];
          relief += std::max(0.0, now - 1.0) - std::max(0.0, then - 1.0);
        }
        if (relief <= slack) continue;
        const double price = (choices[i][j].cost_s - s.at(i).cost_s) / relief;
        if (price < best) best = price, which = i, option = j;
      }
    if (!std::isfinite(best)) break;
    s.take(which, option);
  }
}

/// Exchanges one option, or two at a time, as long as that lowers the cost.
void improve(Selection& s, const std::vector<std::vector<Option>>& choices) {
  for (int round = 0; round < 8; ++round) {
    double max_saved_s = 0.0;
    std::size_t a = 0, option_a = 0, b = 0, option_b = 0;
    for (std::size_t i = 0; i < choices.size(); ++i) {
      if (choices[i].size() < 2) continue;
      for (std::size_t p = 0; p < choices[i].size(); ++p) {
        if (p == s.taken(i)) continue;
        const double saved_s = s.at(i).cost_s - choices[i][p].cost_s;
        if (saved_s > max_saved_s && s.would_fit(s.at(i), choices[i][p]))
          max_saved_s = saved_s, a = b = i, option_a = option_b = p;
        for (std::size_t j = i + 1; j < choices.size(); ++j) {
          for (std::size_t q = 0; q < choices[j].size(); ++q) {
            const double both_s = saved_s + s.at(j).cost_s - choices[j][q].cost_s;
            if (q == s.taken(j) || both_s <= max_saved_s) continue;
            Option less = s.at(i), more = choices[i][p];
            for (std::size_t k = 0; k < kinds; ++k) {
              less.share[k] += s.at(j).share[k];
              more.share[k] += choices[j][q].share[k];
            }
            if (s.would_fit(less, more))
              max_saved_s = both_s, a = i, option_a = p, b = j, option_b = q;
          }
        }
      }
    }
    if (!(max_saved_s > 0.0)) return;
    s.take(a, option_a);
    s.take(b, option_b);
  }
}

}  // namespace

KnapsackResult solve_knapsack(const std::vector<KnapsackChoice>& choices,
                              const ErrorBound& budget) {
  std::vector<std::vector<Option>> options;
  double scale_s = 0.0;
  for (const auto& choice : choices) {
    options.push_back(useful(choice, budget));
    double max_s = 0.0;
    for (const auto& option : options.back()) max_s = std::max(max_s, option.cost_s);
    scale_s += max_s;
  }
  Shares price{};  // [s] for the whole budget
  Selection best(options);
  // The exact options first: they always fit.
  for (std::size_t i = 0; i < options.size(); ++i)
    for (std::size_t j = 0; j < options[i].size(); ++j)
      if (options[i][j].share == Shares{}) best.take(i, j);
  double min_cost_s = 0.0;
  for (int step = 0; step < steps; ++step) {
    Selection s(options);
    double bound_s = 0.0;
    for (std::size_t i = 0; i < options.size(); ++i) {
      double least = unbounded;
      std::size_t taken = 0;
      for (std::size_t j = 0; j < options[i].size(); ++j) {
        double value = options[i][j].cost_s;
        for (std::size_t k = 0; k < kinds; ++k) value += price[k] * options[i][j].share[k];
        if (value < least) least = value, taken = j;
      }
      bound_s += least;
      s.take(i, taken);
    }
    for (const double p : price) bound_s -= p;
    min_cost_s = std::max(min_cost_s, bound_s);
    const double length_s = 0.3 * scale_s / (1.0 + 0.5 * step);
    double slope = 0.0;
    for (const double share : s.share()) slope += (share - 1.0) * (share - 1.0);
    slope = std::sqrt(slope);
    if (slope > 0.0)
      for (std::size_t k = 0; k < kinds; ++k)
        price[k] = std::max(0.0, price[k] + length_s * (s.share()[k] - 1.0) / slope);
    const bool worth_repairing = step % 10 == 9;
    if (worth_repairing) repair(s, options);
    if (s.fits() && s.cost_s() < best.cost_s())
      for (std::size_t i = 0; i < options.size(); ++i) best.take(i, s.taken(i));
    if (min_cost_s >= best.cost_s() * (1.0 - 1e-9)) break;
  }
  improve(best, options);
  KnapsackResult result{.cost_s = 0.0, .min_cost_s = min_cost_s};
  for (std::size_t i = 0; i < options.size(); ++i) {
    result.option.push_back(best.at(i).index);
    result.cost_s += best.at(i).cost_s;
  }
  result.min_cost_s = std::min(result.min_cost_s, result.cost_s);
  return result;
}

}  // namespace dmise
