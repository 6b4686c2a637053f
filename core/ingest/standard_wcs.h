#pragma once
#include <optional>

#include "core/frames/vec.h"
#include "core/ingest/standard_cards.h"
#include "core/wcs/wcs.h"

namespace dmise {

/// The celestial WCS of a header (Calabretta & Greisen 2002, A&A 395, 1077): TAN, ARC, ZEA, STG or
/// ZPN by a CD matrix, PC and CDELT, or CDELT and CROTA2, with right ascension on either axis, any
/// LONPOLE, and SIP, or TPV without terms in the distance. RADESYS ICRS, FK5 or FK4 of any equinox
/// (EPOCH is its old name), and galactic coordinates are turned to ICRS. Empty, with a note of the
/// keyword and the reason, if there is none or it says what this program does not know.
std::optional<Wcs> wcs_of(const StandardCards& cards);

constexpr double longest_focal_px = 1e8;  // 2 mas a pixel

/// A camera that images as a WCS does around the image's middle.
struct CameraView {
  Rotation<CameraFrame, Gcrs> camera_from_gcrs;
  bool mirrored = false;  // rows run against the camera's y axis
  double focal_length_px = 0.0;
};

/// Empty if the WCS images no sky there, or less than a pixel of `longest_focal_px` does.
std::optional<CameraView> view_of(const Wcs& wcs, int columns, int rows);

}  // namespace dmise
