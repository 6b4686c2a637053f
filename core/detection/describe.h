#pragma once
#include <vector>

#include "core/detection/curve/light_curve.h"
#include "core/detection/measured_source.h"
#include "core/detection/source/scene.h"
#include "core/products/detection.h"
#include "core/products/frame_header.h"

namespace dmise {

/// Converts a source to a detection: pixels to directions, electrons to magnitudes, with errors.
/// `id` and `index` are left to the caller.
///
/// x_px, y_px and covariance_px2 are of the fitted centroid of light. Directions are those of the
/// fitted line's point where the object was at mid exposure (core/detection/known/mid_exposure.h):
/// curvature moves it off the centroid, a change of brightness moves the centroid along the line.
/// What was not fitted of both is taken from the circular orbit through the ends, and the air.
/// covariance_rad2 includes the uncertainty of mid exposure and the error of the WCS.
Detection describe(const Source& source, const FrameHeader& header);

/// Describes what another detector found. Its centroid, ends, light and errors are taken as they
/// are. Between its ends a streak is a line through its centroid, of even light, which bends as the
/// orbit does.
Detection describe(const MeasuredSource& source, const FrameHeader& header, bool saturated,
                   bool at_edge);

/// Adds the light along a source to its detection: places from end 1 and times between those of the
/// ends. The period in time allows for ends that the light does not show.
void describe_light(const Source& source, MeasuredCurve measured, const FrameHeader& header,
                    Detection& d);

/// Adds a detection under the next index.
void add_detection(Detection d, const FrameHeader& header, std::vector<Detection>& detections);

}  // namespace dmise
