#pragma once

namespace dmise {

/// Time of planned frames as a share of the reference's, and how well it is predicted.
void measure_thrift(bool json);

}  // namespace dmise
