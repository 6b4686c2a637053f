#include "core/tracking/maintenance/arc_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/tracking/line_of_light.h"

namespace dmise {
namespace {

constexpr double converged = 0.01;  // chi-square that a step may leave
// Added to variances of 1: rounding may leave a covariance without a root.
constexpr double min_relative = 1e-13;
constexpr double least_apart_s = 1.0;  // from a manoeuvre to both ends of an arc

/// Root of a covariance; rows that are known have none.
std::optional<OrbitMatrix> root_of(const OrbitMatrix& covariance) {
  OrbitVector sigma = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (int i = 0; i < orbit_size; ++i)
    if (sigma[i] == 0) sigma[i] = 1.0;
  OrbitMatrix scaled = sigma.cwiseInverse().asDiagonal() * covariance *
                       OrbitMatrix(sigma.cwiseInverse().asDiagonal());
  for (int i = 0; i < orbit_size; ++i) scaled(i, i) += covariance(i, i) > 0 ? min_relative : 1.0;
  const Eigen::LLT<OrbitMatrix> llt(scaled);
  if (llt.info() != Eigen::Success) return std::nullopt;
  OrbitMatrix root = sigma.asDiagonal() * OrbitMatrix(llt.matrixL());
  for (int i = 0; i < orbit_size; ++i)
    if (!(covariance(i, i) > 0)) root.row(i).setZero();
  return root;
}

OrbitState moved(const OrbitState& state, const OrbitVector& by) {
  return state_of(vector_of(state) + by, state.time);
}

Eigen::Matrix<double, orbit_size, 3> velocity_rows(const Eigen::Matrix3d& axes) {
  Eigen::Matrix<double, orbit_size, 3> out = Eigen::Matrix<double, orbit_size, 3>::Zero();
  out.block<3, 3>(3, 0) = axes;
  return out;
}

}  // namespace

Outcome<ArcFit> ArcFit::make(const MaintenanceForces& forces, const OrbitEstimate& prior,
                             std::vector<AngleObservation> observations,
                             std::vector<ManoeuvreGuess> manoeuvres, const ArcFit* start) {
  using Result = Outcome<ArcFit>;
  ArcFit out(forces, prior);
  const auto root = root_of(prior.covariance);
  if (!root) return Result::refused("the prior's covariance is not positive definite");
  out.root_ = *root;
  out.observations_ = std::move(observations);
  out.manoeuvres_ = std::move(manoeuvres);
  for (const ManoeuvreGuess& m : out.manoeuvres_) out.guessed_times_.push_back(m.change.time);
  out.list_noise();
  out.noise_.setZero(long(3 * out.noise_times_.size()));
  out.start_ = prior.state;
  out.values_.setZero(long(out.first_manoeuvre() + 4 * out.manoeuvres_.size()));
  if (start && start->prior_.state == prior.state) {
    out.start_ = start->start_;
    out.values_.head(orbit_size) = start->values_.head(orbit_size);
    const long known = std::min(out.noise_.size(), start->noise_.size());
    out.noise_.head(known) = start->noise_.head(known);
    out.values_.segment(long(out.first_noise()), out.noise_.size()) = out.noise_;
  }
  for (std::size_t k = 0; k < out.manoeuvres_.size(); ++k) {
    const Vec<Rtn>& v = out.manoeuvres_[k].change.delta_v_m_per_s;
    out.values_.segment<3>(long(out.first_manoeuvre() + 4 * k)) =
        Eigen::Vector3d(v.x, v.y, v.z) / forces.settings().manoeuvre_sigma_m_per_s;
  }
  if (const std::string_view reason = out.linearise(); !reason.empty())
    return Result::refused(reason);
  return out;
}

SimTime ArcFit::end_of_observations() const {
  return observations_.empty() ? prior_.state.time + sim_seconds(1.0) : observations_.back().time;
}

void ArcFit::list_noise() {
  const SimTime every = sim_seconds(forces_->settings().noise_every_s);
  for (SimTime t = prior_.state.time + SimTime{every.ns / 2}; t < end_of_observations();
       t = t + every)
    noise_times_.push_back(t);
}

void ArcFit::list_unknowns() {
  unknowns_.clear();
  const MaintenanceSettings& s = forces_->settings();
  const SimTime first = start_.time;
  for (int i = 0; i < orbit_size; ++i) unknowns_.push_back({first, root_.col(i)});
  const auto add = [&](SimTime time, const auto& columns, const OrbitMatrix& back) {
    for (int i = 0; i < columns.cols(); ++i) unknowns_.push_back({time, back * columns.col(i)});
  };
  for (const SimTime time : noise_times_) {
    const OrbitState there = path_->at(time);
    const Eigen::Matrix3d axes = orbit_axes(there);
    const Eigen::Matrix3d sized =
        axes * forces_->noise_m_per_s(there, s.noise_every_s).asDiagonal();
    add(time, velocity_rows(sized), path_->transition(time).inverse());
  }
  for (const auto& [change, time_sigma_s] : manoeuvres_) {
    const OrbitState there = path_->at(change.time);
    const Eigen::Matrix3d axes = orbit_axes(there);
    const OrbitMatrix back = path_->transition(change.time).inverse();
    add(change.time, velocity_rows(axes * s.manoeuvre_sigma_m_per_s), back);
    // A later change acts on a place that the change has not moved, along axes that have turned.
    const Vec<Rtn>& v = change.delta_v_m_per_s;
    const Eigen::Vector3d by = axes * Eigen::Vector3d(v.x, v.y, v.z);
    const Eigen::Vector3d r = eigen_of(there.position_m);
    const Eigen::Vector3d turning = r.cross(eigen_of(there.velocity_m_per_s)) / r.squaredNorm();
    OrbitVector later = OrbitVector::Zero();
    later.head<3>() = -time_sigma_s * by;
    later.segment<3>(3) = time_sigma_s * turning.cross(by);
    add(change.time, later, back);
  }
}

OrbitVector ArcFit::shift_at(SimTime time) const {
  OrbitVector out = OrbitVector::Zero();
  for (std::size_t k = first_noise(); k < first_manoeuvre(); ++k)
    if (unknowns_[k].since < time) out += values_[long(k)] * unknowns_[k].effect;
  return out;
}

void ArcFit::observe(std::size_t i) {
  const AngleObservation& seen = observations_[i];
  const OrbitMatrix transition = path_->transition(seen.time);
  const OrbitState at = moved(path_->at(seen.time), transition * shift_at(seen.time));
  const LineOfLight line = line_of_light(eigen_of(at.position_m), eigen_of(at.velocity_m_per_s),
                                         eigen_of(seen.sensor_m));
  const Vec<Gcrs> direction = gcrs_of(line.line_m / line.range_m);
  const Eigen::LLT<Eigen::Matrix2d> error(dmise::covariance_of(seen));
  residuals_[i] = error.matrixL().solve(angles_between(direction, seen.direction));
  const Eigen::Matrix<double, 2, 6> h =
      error.matrixL().solve(angle_derivatives(line, sky_tangents(direction)));
  const Eigen::Matrix<double, 2, orbit_size> g = h * transition.topRows<6>();
  after_[i].squares = g.transpose() * g;
  after_[i].right = g.transpose() * residuals_[i];
}

std::string_view ArcFit::linearise() {
  std::vector<VelocityChange> changes;
  for (const ManoeuvreGuess& m : manoeuvres_) changes.push_back(m.change);
  std::ranges::sort(changes, {}, &VelocityChange::time);
  if (!changes.empty() &&
      !(start_.time < changes.front().time && changes.back().time < end_of_observations()))
    return "a manoeuvre is not within its observations";
  auto path = ArcPath::fly(*forces_, start_, changes, end_of_observations());
  if (!path) return path.reason;
  path_ = std::move(*path);
  list_unknowns();
  residuals_.resize(observations_.size());
  after_.assign(observations_.size() + 1, {});
  cost_ = values_.squaredNorm();
  for (std::size_t i = observations_.size(); i-- > 0;) {
    observe(i);
    after_[i].squares += after_[i + 1].squares;
    after_[i].right += after_[i + 1].right;
    cost_ += residuals_[i].squaredNorm();
  }
  solve();
  return {};
}

const ArcInformation& ArcFit::information_after(SimTime time) const {
  const auto first = std::ranges::upper_bound(observations_, time, {}, &AngleObservation::time);
  return after_[std::size_t(first - observations_.begin())];
}

void ArcFit::solve() {
  const long n = long(unknowns_.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd right(n);
  for (long i = 0; i < n; ++i) {
    const ArcUnknown& a = unknowns_[std::size_t(i)];
    const ArcInformation& known = information_after(a.since);
    right[i] = a.effect.dot(known.right) - values_[i];
    const OrbitVector seen = known.squares * a.effect;
    for (long j = 0; j <= i; ++j) {
      const ArcUnknown& b = unknowns_[std::size_t(j)];
      const double both = b.since <= a.since
                              ? b.effect.dot(seen)
                              : b.effect.dot(information_after(b.since).squares * a.effect);
      normal(i, j) += both;
      if (i != j) normal(j, i) += both;
    }
  }
  information_root_.compute(normal);
  step_ = information_root_.solve(right);
  left_ = step_.dot(right);
}

void ArcFit::move(const Eigen::VectorXd& by) {
  values_ += by;
  const MaintenanceSettings& s = forces_->settings();
  start_ = moved(prior_.state, root_ * values_.head<orbit_size>());
  noise_ = values_.segment(long(first_noise()), noise_.size());
  for (std::size_t k = 0; k < manoeuvres_.size(); ++k) {
    const long row = long(first_manoeuvre() + 4 * k);
    ManoeuvreGuess& m = manoeuvres_[k];
    m.change.delta_v_m_per_s = {values_[row] * s.manoeuvre_sigma_m_per_s,
                                values_[row + 1] * s.manoeuvre_sigma_m_per_s,
                                values_[row + 2] * s.manoeuvre_sigma_m_per_s};
    if (!(m.time_sigma_s > 0)) continue;
    const SimTime wanted = guessed_times_[k] + sim_seconds(values_[row + 3] * m.time_sigma_s);
    m.change.time = std::clamp(wanted, start_.time + sim_seconds(least_apart_s),
                               end_of_observations() - sim_seconds(least_apart_s));
    values_[row + 3] = (m.change.time - guessed_times_[k]).seconds() / m.time_sigma_s;
  }
}

std::string_view ArcFit::iterate(int max_iterations) {
  for (int i = 0; i < max_iterations && left_ > converged; ++i) {
    const ArcFit before = *this;
    double share = 1.0;
    for (int halvings = 0; halvings < 6; ++halvings, share *= 0.4) {
      *this = before;
      move(share * before.step_);
      if (linearise().empty() && cost_ < before.cost_) break;
    }
    if (!(cost_ < before.cost_)) {
      *this = before;
      return {};
    }
  }
  return {};
}

Eigen::MatrixXd ArcFit::effects_at(SimTime time) const {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(orbit_size, long(unknowns_.size()));
  for (std::size_t k = 0; k < unknowns_.size(); ++k)
    if (unknowns_[k].since < time || k < orbit_size) all.col(long(k)) = unknowns_[k].effect;
  return path_->transition(time) * all;
}

Outcome<OrbitEstimate> ArcFit::estimate_at(SimTime time) const {
  const SimTime there = std::clamp(time, path_->start(), path_->end());
  OrbitEstimate out;
  out.state = moved(path_->at(there), path_->transition(there) * shift_at(there));
  // By the root of the information, so that nothing is subtracted.
  const Eigen::MatrixXd half = information_root_.matrixL().solve(effects_at(there).transpose());
  out.covariance = half.transpose() * half;
  return there < time ? move_on(*forces_, out, time) : Outcome<OrbitEstimate>(out);
}

Eigen::Matrix4d ArcFit::covariance_of(std::size_t k) const {
  const double v = forces_->settings().manoeuvre_sigma_m_per_s;
  const Eigen::Vector4d sigma(v, v, v, manoeuvres_[k].time_sigma_s);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(long(unknowns_.size()), 4);
  columns.middleRows<4>(long(first_manoeuvre() + 4 * k)) = sigma.asDiagonal();
  const Eigen::MatrixXd half = information_root_.matrixL().solve(columns);
  return half.transpose() * half;
}

OrbitEstimate perhaps_manoeuvred(OrbitEstimate estimate, double sigma_m_per_s) {
  estimate.covariance.block<3, 3>(3, 3) +=
      sigma_m_per_s * sigma_m_per_s * Eigen::Matrix3d::Identity();
  return estimate;
}

OrbitEstimate moved_along(const MaintenanceForces& forces, const ArcPath& path,
                          const OrbitMatrix& covariance, SimTime to) {
  const OrbitMatrix all = path.transition(to);
  OrbitEstimate out{path.at(to), all * covariance * all.transpose()};
  const double every_s = forces.settings().noise_every_s, sense = to < path.start() ? -1 : 1;
  for (SimTime t = path.start(); sense * (to - t).seconds() > 0;
       t = t + sim_seconds(sense * every_s)) {
    const double length_s = std::min(every_s, std::fabs((to - t).seconds()));
    const SimTime middle = t + sim_seconds(sense * length_s / 2);
    const OrbitState there = path.at(middle);
    const Eigen::Matrix<double, orbit_size, 3> sized =
        velocity_rows(orbit_axes(there) * forces.noise_m_per_s(there, length_s).asDiagonal());
    const Eigen::Matrix<double, orbit_size, 3> effect =
        all * path.transition(middle).inverse() * sized;
    out.covariance += effect * effect.transpose();
  }
  out.covariance = 0.5 * (out.covariance + out.covariance.transpose()).eval();
  return out;
}

Outcome<OrbitEstimate> move_on(const MaintenanceForces& forces, const OrbitEstimate& estimate,
                               SimTime to) {
  if (!(estimate.state.time < to)) return estimate;
  const auto path = ArcPath::fly(forces, estimate.state, {}, to);
  if (!path) return Outcome<OrbitEstimate>::refused(path.reason);
  return moved_along(forces, *path, estimate.covariance, to);
}

}  // namespace dmise
