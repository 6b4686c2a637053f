#pragma once
#include <string>

namespace dmise {

struct ExportRequest;

/// COCO. Truth: images, annotations (box, polygon, start and end as keypoints), the category
/// "satellite". Detections: results with their SNR as score, for `loadRes` beside the truth of the
/// same run and sensors. The first pixel extends from (0, 0) to (1, 1): pixel positions plus 0.5.
std::string coco_json(const ExportRequest& request);

}  // namespace dmise
