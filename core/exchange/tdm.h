#pragma once
#include <string>

namespace dmise {

struct ExportRequest;

/// A CCSDS Tracking Data Message (503.0-B-2) in KVN: RADEC angles in ICRF, apparent magnitudes,
/// UTC time tags of reception at mid exposure. Detections: one segment each, for one frame does not
/// tell which of them are of one object; TRACK_ID is the detection's id. Tracks: the
/// detections that confirmed tracks took, with the track's name. Truth: one segment for
/// each pair of sensor and object. Angles are corrected as CORRECTION_ANGLE_n and comments state;
/// 1e-9 deg are kept.
std::string tdm_text(const ExportRequest& request);

}  // namespace dmise
