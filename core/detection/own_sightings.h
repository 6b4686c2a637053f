#pragma once
#include "core/frames/vec.h"
#include "core/products/detection.h"
#include "core/products/frame_report.h"
#include "core/products/own_sighting.h"

namespace dmise {

inline constexpr std::size_t max_sightings = 100'000;  // in an exposure

/// Throws `Error` "KEY: reason, got VALUE" for what can't have been seen from `start` to `end`.
void check_observed(const Observed& observed, SimTime start, SimTime end);

/// Right ascension in [0, 2 pi), of one that `check_observed` accepts.
double right_ascension_rad(double told_rad);

/// World coordinates of an exposure without an image: equidistant about the boresight, 1 px is
/// 1 deg.
Wcs wcs_without_image(double boresight_ra_rad, double boresight_dec_rad);

/// The detection of what `check_observed` accepts, without its id. `report`: of its frame. The
/// sensor's position and velocity are those at the time of the sighting.
Detection detection_of(const OwnSighting& sighting, const FrameReport& report,
                       const Vec<Gcrs>& sensor_m, const Vec<Gcrs>& sensor_m_per_s);

}  // namespace dmise
