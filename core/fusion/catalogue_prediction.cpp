#include "core/fusion/catalogue_prediction.h"

#include <algorithm>
#include <cmath>

#include "core/orbit/elements/epoch.h"

namespace dmise {

CataloguePrediction::CataloguePrediction(std::vector<MeanElements> elements, const Clock& clock,
                                         const FusionSettings& settings)
    : elements_(std::move(elements)),
      clock_(clock),
      settings_(settings),
      batch_(elements_),
      position_m_(3 * elements_.size()),
      velocity_m_per_s_(3 * elements_.size()),
      code_(elements_.size(), 1) {}

void CataloguePrediction::move(SimTime time) {
  time_ = time;
  utc_ = clock_.utc(time);
  gcrs_from_teme_ = earth_orientation(clock_, time).gcrs_from_teme(time);
  if (size() > 0) batch_.propagate(utc_.jd1, utc_.jd2, position_m_, velocity_m_per_s_, code_);
}

double CataloguePrediction::sigma_m(std::size_t i, std::size_t axis) const {
  const MeanElements& e = elements_[i];
  const double age_days = std::fabs(epoch_days_between({e.epoch_jd1, e.epoch_jd2}, utc_));
  return settings_.catalogue_sigma_m[axis] + settings_.catalogue_sigma_m_per_day[axis] * age_days;
}

double CataloguePrediction::sigma_m(std::size_t i) const {
  return std::max({sigma_m(i, 0), sigma_m(i, 1), sigma_m(i, 2)});
}

OrbitEstimate CataloguePrediction::estimate(std::size_t i) const {
  OrbitEstimate out;
  out.state = {.time = time_, .position_m = position_m(i), .velocity_m_per_s = velocity_m_per_s(i)};
  const Vec<Gcrs> r = out.state.position_m, v = out.state.velocity_m_per_s;
  const Eigen::Matrix3d axes = orbit_axes(out.state);
  const double turn_rad_per_s = norm(cross(r, v)) / dot(r, r);
  const Eigen::Vector3d place(sigma_m(i, 0), sigma_m(i, 1), sigma_m(i, 2));
  const Eigen::Vector3d rate = turn_rad_per_s * Eigen::Vector3d(place[1], place[0], place[2]);
  const auto turned = [&](const Eigen::Vector3d& sigma) -> Eigen::Matrix3d {
    return axes * sigma.array().square().matrix().asDiagonal() * axes.transpose();
  };
  out.covariance.topLeftCorner<3, 3>() = turned(place);
  out.covariance.block<3, 3>(3, 3) = turned(rate);
  return out;
}

}  // namespace dmise
