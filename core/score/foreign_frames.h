#pragma once
#include <string>
#include <vector>

#include "core/astrometry/calibrated_detection.h"
#include "core/base/parallel.h"
#include "core/score/score_input.h"

namespace dmise {

/// Help text: the columns of a table of truth.
inline constexpr const char* truth_csv_help =
    "CSV with the header file,id,x_px,y_px and, as far as known, "
    "end1_x_px,end1_y_px,end2_x_px,end2_y_px,magnitude,signal_e,ra_deg,dec_deg in any order; "
    "fields may be empty. Pixels: 0 is the centre of the first pixel (FITS counts it 1: subtract "
    "1), y along rows as stored. x_px, y_px: centroid of the light in the frame; ends: of the "
    "trail, also outside. signal_e: electrons in the frame. ra_deg, dec_deg: direction at mid "
    "exposure as corrected_ra_deg, corrected_dec_deg of detections, without aberration and "
    "refraction, not as ra_deg, dec_deg by the WCS";

/// Reads such a table; `files`: the names of frames. Throws `ConfigError`
/// "FILE:LINE: COLUMN: reason".
std::vector<TrueSource> read_truth_csv(const std::string& path,
                                       const std::vector<std::string>& files);
/// Parses its text; `name`: of the file, for messages.
std::vector<TrueSource> parse_truth_csv(const std::string& text, const std::string& name,
                                        const std::vector<std::string>& files);

/// Detects in every FITS file of a directory (.fits .fit .fts, also with .gz or .fz), as `dmise
/// detect` does, and reads its truth from a CSV file.
ScoreInput read_frames(const std::string& directory, const std::string& truth_csv, Threads& threads,
                       const ReadProgress& progress, const CalibratedDetector& detector);

}  // namespace dmise
