#include "core/tracking/maintenance/catalogue_object.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dmise {
namespace {

constexpr double candidate_s = 600.0;     // between times at which a manoeuvre is tried
constexpr double first_candidate = 0.6;   // gain to first order, over the wanted one
constexpr double settled_s = 8 * 3600.0;  // observations' time before manoeuvres are looked for
constexpr int settled_arcs = 3;
constexpr double max_windows = 1.5;    // to which a window grows while a manoeuvre is uncertain
constexpr double walk_per_day = 0.04;  // growth of drag's and sunlight's variance, over the prior's

}  // namespace

CatalogueObject::CatalogueObject(const MaintenanceForces& forces, const OrbitEstimate& prior)
    : forces_(&forces),
      prior_(prior),
      scale_variances_(prior.covariance(drag_row, drag_row), prior.covariance(srp_row, srp_row)) {}

SimTime CatalogueObject::time() const { return fit_ ? fit_->end() : prior_.state.time; }

Outcome<OrbitEstimate> CatalogueObject::estimate_at(SimTime time) const {
  return fit_ ? fit_->estimate_at(time) : move_on(*forces_, prior_, time);
}

bool CatalogueObject::is_settled() const {
  return fit_ && arcs_ >= settled_arcs &&
         (fit_->end() - fit_->observations().front().time).seconds() >= settled_s;
}

Outcome<ArcFit> CatalogueObject::with_arc(const std::vector<AngleObservation>& arc) const {
  std::vector<AngleObservation> all;
  if (fit_) all = fit_->observations();
  all.insert(all.end(), arc.begin(), arc.end());
  return ArcFit::make(*forces_, prior_, std::move(all),
                      fit_ ? guesses_of(*fit_) : std::vector<ManoeuvreGuess>{},
                      fit_ ? &*fit_ : nullptr);
}

void CatalogueObject::place(ArcFit& fit, std::size_t k, FoundManoeuvre& known) const {
  const auto all = modes_of(*forces_, fit, k);
  if (!all) return;
  known.change = all->modes.front().change;
  known.time_sigma_s = all->time_sigma_s();
  known.covariance = all->covariance();
  known.modes = all->modes;
  known.gain = all->gain;
  known.confidence = confidence_of(all->gain, all->times);
}

std::optional<FoundManoeuvre> CatalogueObject::search(const ArcFit& before, ArcFit& fit) const {
  const double wanted = forces_->settings().manoeuvre_gain;
  const auto all = ManoeuvreScan(*forces_, before).every(candidate_s);
  const ManoeuvreCandidate* best = best_of(all);
  if (!best || best->gain < first_candidate * wanted) return std::nullopt;
  auto with_it = guesses_of(before);
  with_it.push_back({best->change, manoeuvre_shift_s});
  auto other = ArcFit::make(*forces_, before.prior(), before.observations(), with_it, &before);
  if (!other) return std::nullopt;
  other->iterate();
  if (fit.cost() - other->cost() < wanted) return std::nullopt;
  FoundManoeuvre out{.found = fit.end()};
  place(*other, other->manoeuvres().size() - 1, out);
  if (out.gain < wanted) return std::nullopt;  // others explain it
  fit = std::move(*other);
  return out;
}

std::size_t CatalogueObject::leave_outliers_out(ArcFit& fit, SimTime since) const {
  std::vector<AngleObservation> kept;
  for (std::size_t i = 0; i < fit.observations().size(); ++i)
    if (fit.observations()[i].time < since || fit.d2(i) < forces_->settings().outlier_d2)
      kept.push_back(fit.observations()[i]);
  const std::size_t out = fit.observations().size() - kept.size();
  if (out == 0 || kept.empty()) return 0;
  auto other = ArcFit::make(*forces_, fit.prior(), std::move(kept), guesses_of(fit), &fit);
  if (!other) return 0;
  other->iterate();
  fit = std::move(*other);
  return out;
}

Outcome<ArcNews> CatalogueObject::take(const std::vector<AngleObservation>& arc) {
  using Result = Outcome<ArcNews>;
  if (arc.empty()) return Result::refused("there are no observations");
  for (std::size_t i = 0; i < arc.size(); ++i) {
    if (const std::string_view fault = fault_of(arc[i]); !fault.empty())
      return Result::refused(fault);
    if (arc[i].time < (i ? arc[i - 1].time : time()))
      return Result::refused("an observation is before the last");
  }
  auto made = with_arc(arc);
  if (!made) return Result::refused(made.reason);
  const ArcFit before = *made;
  ArcFit& fit = *made;
  ArcNews news{.innovation_d2 = fit.cost() - fit.left() - (fit_ ? fit_->cost() : 0.0),
               .degrees = int(2 * arc.size())};
  fit.iterate();
  auto found = manoeuvres_;
  for (std::size_t k = 0; k < fit.manoeuvres().size(); ++k) place(fit, k, found[first_fitted_ + k]);
  if (is_settled()) news.manoeuvre = search(before, fit);
  news.outliers = leave_outliers_out(fit, arc.front().time);
  for (std::size_t i = 0; i < fit.observations().size(); ++i)
    if (arc.front().time <= fit.observations()[i].time) news.residual_d2 += fit.d2(i);
  manoeuvres_ = std::move(found);
  if (news.manoeuvre) {
    manoeuvres_.push_back(*news.manoeuvre);
    // What was believed between the manoeuvre and its discovery is no prior.
    const SimTime since =
        news.manoeuvre->change.time - sim_seconds(2 * news.manoeuvre->time_sigma_s);
    std::erase_if(after_, [&](const OrbitEstimate& e) { return since < e.state.time; });
  }
  ++arcs_;
  keep(std::move(fit));
  return news;
}

void CatalogueObject::keep(ArcFit&& fit) {
  fit_ = std::move(fit);
  // What is believed while a manoeuvre may have been at several times is no prior.
  const bool is_certain = std::all_of(
      manoeuvres_.begin() + long(first_fitted_), manoeuvres_.end(), [](const FoundManoeuvre& m) {
        return m.modes.size() == 1 && m.time_sigma_s < manoeuvre_shift_s;
      });
  const double longest_s = max_windows * forces_->settings().window_s;
  const bool is_long = (fit_->end() - prior_.state.time).seconds() > longest_s;
  if (is_certain || is_long)
    if (const auto now = fit_->estimate_at(fit_->end())) after_.push_back(*now);
  slide();
}

void CatalogueObject::slide() {
  const MaintenanceSettings& s = forces_->settings();
  if ((fit_->end() - prior_.state.time).seconds() < s.window_s) return;
  const SimTime oldest = fit_->end() - sim_seconds(s.kept_s);
  const auto later =
      std::ranges::find_if(after_, [&](const OrbitEstimate& e) { return oldest < e.state.time; });
  if (later == after_.begin()) return;
  OrbitEstimate prior = *(later - 1);
  const double days = (prior.state.time - prior_.state.time).seconds() / 86400;
  for (int i = 0; i < 2; ++i)
    prior.covariance(drag_row + i, drag_row + i) += walk_per_day * days * scale_variances_[i];
  std::vector<AngleObservation> kept;
  for (const AngleObservation& o : fit_->observations())
    if (prior.state.time < o.time) kept.push_back(o);
  std::vector<ManoeuvreGuess> open;
  std::size_t given_up = 0;
  for (const ManoeuvreGuess& m : guesses_of(*fit_)) {
    if (prior.state.time + sim_seconds(manoeuvre_shift_s) < m.change.time)
      open.push_back(m);
    else if (m.change.time < prior.state.time && open.empty())
      ++given_up;
    else
      return;  // it may yet move across the prior
  }
  auto fit = ArcFit::make(*forces_, prior, std::move(kept), open);
  if (!fit) return;
  fit->iterate();
  prior_ = std::move(prior);
  after_.erase(after_.begin(), later);
  fit_ = std::move(*fit);
  first_fitted_ += given_up;
}

}  // namespace dmise
