#pragma once
#include <vector>

namespace dmise {

/// Gives each pixel back what its neighbours see of it; the outermost pixels stay as they are.
/// `coupling`: the share of a pixel's charge that each of its four neighbours sees.
void uncouple(double coupling, int columns, std::vector<float>& values);

/// What a straight response would have shown, where a signal S lost `loss_per_dn` S of itself.
void straighten(double loss_per_dn, std::vector<float>& light);

}  // namespace dmise
