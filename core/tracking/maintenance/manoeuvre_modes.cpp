#include "core/tracking/maintenance/manoeuvre_modes.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/golden_section.h"

namespace dmise {
namespace {

constexpr double coarse_s = 600.0;  // an orbit near the Earth has its peaks half a turn apart
constexpr double refined_s = 10.0;  // to which a peak is found
constexpr std::size_t max_modes = 24;
constexpr double min_chance = 1e-3;
// Fall of the logarithm of a peak's evidence, below which no fit is tried: absolute, and a share of
// the gain, since peaks far from a fit are known to first order only.
constexpr double peak_depth = 9.0, peak_depth_share = 0.003;
constexpr double sum_depth = 9.0;   // at which a sum over a peak ends, in the logarithm
constexpr double first_step = 0.4;  // in deviations of the time
constexpr double min_step_s = 0.1;
constexpr double step_growth = 1.3;
constexpr int max_sum_steps = 60;
constexpr double resolved_depth = 2.0;  // above which a peak is to have some candidates
constexpr int resolved_by = 3;

Eigen::Vector3d size_of(const VelocityChange& change) {
  return {change.delta_v_m_per_s.x, change.delta_v_m_per_s.y, change.delta_v_m_per_s.z};
}

/// A peak of the evidence, between the valleys beside it.
struct Peak {
  ManoeuvreCandidate best;
  SimTime from, to;
};

ManoeuvreCandidate refined(const ManoeuvreScan& scan, SimTime from, SimTime to) {
  const auto at = [&](double after_s) { return scan.at(from + sim_seconds(after_s)); };
  const Least least = golden_section([&](double after_s) { return -at(after_s).log_evidence; }, 0.0,
                                     (to - from).seconds(), refined_s);
  return at(least.at);
}

std::vector<Peak> peaks_of(const ManoeuvreScan& scan,
                           const std::vector<ManoeuvreCandidate>& coarse) {
  std::vector<Peak> out;
  const auto evidence = [&](std::size_t i) { return coarse[i].log_evidence; };
  const std::size_t last = coarse.size() - 1;
  for (std::size_t i = 0, valley = 0; i <= last; ++i) {
    const bool rises = i == 0 || evidence(i) > evidence(i - 1);
    const bool falls = i == last || evidence(i) >= evidence(i + 1);
    if (!rises) valley = i;
    if (!rises || !falls) continue;
    std::size_t next = i;
    while (next < last && evidence(next + 1) <= evidence(next)) ++next;
    const SimTime left = coarse[i ? i - 1 : 0].change.time;
    const SimTime right = coarse[std::min(i + 1, last)].change.time;
    out.push_back(
        {refined(scan, left, right), coarse[valley].change.time, coarse[next].change.time});
  }
  if (out.empty()) return out;  // no evidence is a number
  std::ranges::sort(
      out, [](const Peak& a, const Peak& b) { return a.best.log_evidence > b.best.log_evidence; });
  const double least =
      out.front().best.log_evidence - peak_depth - peak_depth_share * out.front().best.gain;
  std::erase_if(out, [&](const Peak& p) { return p.best.log_evidence < least; });
  out.resize(std::min(out.size(), max_modes));
  return out;
}

/// A candidate whose size is as likely in any decade, instead of about that of the settings.
ManoeuvreCandidate weighed_at(const ManoeuvreScan& scan, SimTime time) {
  ManoeuvreCandidate out = scan.at(time);
  const double square = size_of(out.change).squaredNorm() + out.covariance.trace();
  if (square > 0) out.log_evidence -= 1.5 * std::log(square);
  return out;
}

/// Candidates around a time, by rising time, in steps that grow from the first.
std::vector<ManoeuvreCandidate> candidates_around(const ManoeuvreScan& scan, const Peak& peak,
                                                  SimTime centre, double first_step_s) {
  std::vector<ManoeuvreCandidate> out{weighed_at(scan, centre)};
  double most = out.front().log_evidence;
  const auto walk = [&](double sign, SimTime end) {
    SimTime t = centre;
    double step_s = first_step_s;
    for (int i = 0; i < max_sum_steps && t != end; ++i, step_s *= step_growth) {
      t = t + sim_seconds(sign * step_s);
      if (sign * (t - end).seconds() > 0) t = end;
      out.push_back(weighed_at(scan, t));
      most = std::max(most, out.back().log_evidence);
      if (out.back().log_evidence < most - sum_depth) return;
    }
  };
  walk(-1, peak.from);
  walk(1, peak.to);
  std::ranges::sort(out, {}, [](const ManoeuvreCandidate& c) { return c.change.time; });
  return out;
}

/// A mode whose chance is not known yet, and the logarithm of its evidence.
struct Sum {
  ManoeuvreMode mode;
  double log_evidence = 0.0;
};

Sum sum_over(const std::vector<ManoeuvreCandidate>& all) {
  const ManoeuvreCandidate& best =
      *std::ranges::max_element(all, {}, &ManoeuvreCandidate::log_evidence);
  double sum = 0, time_s = 0, square_s2 = 0;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero(), given = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ManoeuvreCandidate& before = all[i ? i - 1 : 0];
    const ManoeuvreCandidate& after = all[std::min(i + 1, all.size() - 1)];
    const double weight = std::exp(all[i].log_evidence - best.log_evidence) *
                          (after.change.time - before.change.time).seconds() / 2;
    const double off_s = (all[i].change.time - best.change.time).seconds();
    const Eigen::Vector3d off = size_of(all[i].change) - size_of(best.change);
    sum += weight;
    time_s += weight * off_s;
    square_s2 += weight * off_s * off_s;
    size += weight * off;
    square += weight * off * off.transpose();
    given += weight * all[i].covariance;
  }
  if (!(sum > 0)) return {{best.change, min_step_s, best.covariance, 0.0}, best.log_evidence};
  time_s /= sum;
  size /= sum;
  const Eigen::Vector3d mean = size_of(best.change) + size;
  ManoeuvreMode mode{
      .change = {best.change.time + sim_seconds(time_s), {mean[0], mean[1], mean[2]}}};
  mode.time_sigma_s =
      std::max(min_step_s, std::sqrt(std::max(0.0, square_s2 / sum - time_s * time_s)));
  mode.covariance = (square + given) / sum - size * size.transpose();
  return {mode, best.log_evidence + std::log(sum)};
}

/// The sum over a peak, about the best time in it, in steps by which it is resolved.
Sum sum_at(const ManoeuvreScan& scan, const Peak& peak, SimTime centre, double sigma_s) {
  double step_s = std::clamp(first_step * sigma_s, min_step_s, coarse_s / 2);
  for (;; step_s = std::max(step_s / 4, min_step_s)) {
    const auto all = candidates_around(scan, peak, centre, step_s);
    const ManoeuvreCandidate& best =
        *std::ranges::max_element(all, {}, &ManoeuvreCandidate::log_evidence);
    const auto high = std::ranges::count_if(all, [&](const ManoeuvreCandidate& c) {
      return c.log_evidence > best.log_evidence - resolved_depth;
    });
    if (high >= resolved_by || step_s <= min_step_s) return sum_over(all);
    centre = best.change.time;
  }
}

/// Fills the chances, drops what has next to none, and puts the likeliest first.
std::vector<ManoeuvreMode> weighed(std::vector<Sum> sums) {
  std::ranges::sort(sums,
                    [](const Sum& a, const Sum& b) { return a.log_evidence > b.log_evidence; });
  double all = 0;
  std::vector<ManoeuvreMode> out;
  for (const Sum& s : sums) {
    const double chance = std::exp(s.log_evidence - sums.front().log_evidence);
    if (chance < min_chance) break;
    all += chance;
    out.push_back(s.mode);
    out.back().chance = chance;
  }
  for (ManoeuvreMode& mode : out) mode.chance /= all;
  return out;
}

bool is_within(const Peak& peak, SimTime time) { return peak.from <= time && time <= peak.to; }

/// A fit that is linearised with its manoeuvre at a peak.
std::optional<ArcFit> fit_at(const MaintenanceForces& forces, const ArcFit& fit, std::size_t k,
                             const Peak& peak) {
  if (is_within(peak, fit.manoeuvres()[k].change.time)) return fit;
  auto moved = guesses_of(fit);
  moved[k].change = peak.best.change;
  auto other = ArcFit::make(forces, fit.prior(), fit.observations(), moved, &fit);
  if (!other) return std::nullopt;
  return std::move(*other);
}

/// Looks from one fit, to whose first order other peaks are found.
std::optional<ManoeuvreModes> look_from(const MaintenanceForces& forces, ArcFit& fit,
                                        std::size_t k) {
  const ManoeuvreScan near(forces, fit, k);
  const auto coarse = near.every(coarse_s);
  if (coarse.empty()) return std::nullopt;
  std::vector<Sum> sums;
  std::optional<ArcFit> likeliest;
  ManoeuvreModes out{.times = coarse.size()};
  double best = 0.0;
  for (const Peak& peak : peaks_of(near, coarse)) {
    auto there = fit_at(forces, fit, k, peak);
    if (!there) continue;
    const SimTime centre = there->manoeuvres()[k].change.time;
    const ManoeuvreScan scan(forces, *there, k);
    sums.push_back(sum_at(scan, peak, centre, std::sqrt(there->covariance_of(k)(3, 3))));
    if (likeliest && sums.back().log_evidence <= best) continue;
    best = sums.back().log_evidence;
    out.gain = scan.at(centre).gain;
    likeliest = std::move(there);
  }
  if (sums.empty()) return std::nullopt;
  likeliest->iterate();
  fit = std::move(*likeliest);
  out.modes = weighed(std::move(sums));
  return out;
}

}  // namespace

double ManoeuvreModes::time_sigma_s() const {
  double sum = 0;
  for (const ManoeuvreMode& m : modes) {
    const double off_s = (m.change.time - modes.front().change.time).seconds();
    sum += m.chance * (m.time_sigma_s * m.time_sigma_s + off_s * off_s);
  }
  return std::sqrt(sum);
}

Eigen::Matrix3d ManoeuvreModes::covariance() const {
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  for (const ManoeuvreMode& m : modes) {
    const Eigen::Vector3d off = size_of(m.change) - size_of(modes.front().change);
    out += m.chance * (m.covariance + off * off.transpose());
  }
  return out;
}

std::vector<ManoeuvreGuess> guesses_of(const ArcFit& fit) {
  std::vector<ManoeuvreGuess> out = fit.manoeuvres();
  for (ManoeuvreGuess& guess : out) guess.time_sigma_s = manoeuvre_shift_s;
  return out;
}

std::optional<ManoeuvreModes> modes_of(const MaintenanceForces& forces, ArcFit& fit,
                                       std::size_t k) {
  const SimTime before = fit.manoeuvres()[k].change.time;
  auto out = look_from(forces, fit, k);
  if (out && std::fabs((fit.manoeuvres()[k].change.time - before).seconds()) > coarse_s)
    out = look_from(forces, fit, k);
  return out;
}

}  // namespace dmise
