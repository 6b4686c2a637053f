#pragma once

namespace dmise {

/// Eccentric anomaly E [rad] of the mean anomaly `mean_anomaly_rad` (any finite; E keeps its turns)
/// at `eccentricity` in [0, 1): E - e sin E = M. Relative error below 1e-15 for |M| <= pi down to
/// 1e-300, also as e -> 1; beyond, that of M's own last digit. Throws `Error` outside these ranges.
double eccentric_anomaly_rad(double mean_anomaly_rad, double eccentricity);

}  // namespace dmise
