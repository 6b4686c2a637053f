#pragma once
#include <span>
#include <vector>

#include "core/forces/forces.h"
#include "core/tracking/angle_observation.h"
#include "core/tracking/batch.h"
#include "core/tracking/initial/admissible_region.h"
#include "core/tracking/initial/triangulate.h"
#include "core/tracking/orbit_state.h"
#include "core/tracking/outcome.h"

namespace dmise {

/// Gauss's method with the light time of each line, improved by f and g functions until the ranges
/// settle (Curtis, algorithms 5.5 and 5.6). One state at the middle observation for each positive
/// root. Three observations in order of time. Refuses equal times, a vanishing arc, and sensors and
/// lines in one plane, where the ranges are not determined.
Outcome<std::vector<OrbitState>> gauss_orbit(std::span<const AngleObservation> three,
                                             const OrbitLimits& limits = {});

struct GoodingSettings {
  std::vector<double> ranges_m;  // guesses of first and last range; empty: from 300 km to GEO
  int max_half_turns = 1;        // between first and last observation
  OrbitLimits limits;
};

/// Gooding's method (1996): ranges of the first and the last line are moved until Lambert's path
/// passes through the middle line. All roots found from the guesses, without repetitions, at the
/// time of the first observation. Refuses lines whose errors leave a range open by a factor of e,
/// such as those from a site in the orbit's plane.
Outcome<std::vector<OrbitState>> gooding_orbit(std::span<const AngleObservation> three,
                                               const GoodingSettings& settings = {});

/// An orbit from two or more sites: positions are triangulated from observations at about the same
/// time, the first and the last are joined by Lambert's path, and all observations are fitted.
/// `observations` in any order.
Outcome<BatchFit> two_site_orbit(const ForceModel& forces,
                                 std::span<const AngleObservation> observations,
                                 const TriangulationSettings& triangulation = {},
                                 const BatchSettings& batch = {});

/// An orbit from one arc of one or more sites, without a guess: Gooding, Gauss and the admissible
/// region give candidates, all observations choose among them by their fit. Refuses if none fits.
Outcome<BatchFit> one_arc_orbit(const ForceModel& forces,
                                std::span<const AngleObservation> observations,
                                const BatchSettings& batch = {}, const OrbitLimits& limits = {});

/// Returns all orbits within the limits to which the candidates lead, by growing
/// chi-square; one may be there several times. Residuals are in order of time.
Outcome<std::vector<BatchFit>> one_arc_orbits(const ForceModel& forces,
                                              std::span<const AngleObservation> observations,
                                              const BatchSettings& batch = {},
                                              const OrbitLimits& limits = {});

}  // namespace dmise
