#pragma once
#include <optional>
#include <string>

#include "core/astrometry/plate_solver.h"
#include "core/astrometry/zero_point.h"
#include "core/base/parallel.h"
#include "core/image/fits_file.h"
#include "core/wcs/wcs.h"

namespace dmise {

struct SolveSettings {
  bool blind = false;  // uses neither the believed pointing nor the focal length
  // Whether the whole sky is searched if there is no solution near the header's RA and DEC.
  bool elsewhere = true;
  PlateSearch search;
};

/// The calibration of a frame by its stars.
struct FrameSolution {
  PlateSolution plate;
  Wcs wcs;  // astrometric, so annual aberration and refraction are in it
  std::optional<ZeroPoint> zero_point;
  std::size_t sources = 0;
  FrameNotes notes;  // what it took for granted, beside the frame's
};

/// Solves a frame by its counts and its header's site, time, lens and detector. The header's
/// pointing, or RA and DEC alone, is a hint; without one the whole sky is searched. A frame without
/// a time is solved at J2000, which is noted. Throws `Error` if there is no solution.
FrameSolution solve_frame(const Frame& frame, const StarMap& stars, const SolveSettings& settings,
                          Threads& threads);

/// `header` with the solution: WCS, attitudes, focal length, zero point and extinction.
FrameHeader solved_header(const FrameHeader& header, const FrameSolution& solution);

/// The solution as one line of JSON, with the frame's notes, if it has any.
std::string to_json(const FrameSolution& solution, const FrameHeader& header,
                    const FrameNotes& notes = {});

}  // namespace dmise
