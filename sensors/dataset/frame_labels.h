#pragma once
#include <string>
#include <vector>

#include "core/config/scenario_draws.h"
#include "core/dataset/object_mask.h"
#include "core/time/clock.h"
#include "sensors/frame/frame_pipeline.h"

namespace dmise {

/// An object of a frame with the pixels that its light is in.
struct ObjectLabel {
  Truth truth;
  ObjectMask mask;
  double snr = 0.0;  // `optimal_snr`
};

/// One frame of a sample with its labels.
struct LabelledFrame {
  const FrameProducts& frame;
  const std::vector<ObjectLabel>& objects;
  const DrawnScenario& sample;
  const Clock& clock;
  std::string digest;  // names the data set
  std::string key;     // begins the names of its files

  int columns() const { return frame.counts.columns; }
  int rows() const { return frame.counts.rows; }
};

/// JSON of all that is known of a frame: its report, the values drawn, its objects and detections.
/// Places of boxes are COCO's: the first pixel extends from (0, 0) to (1, 1).
std::string labels_json(const LabelledFrame& labelled);

/// COCO's image and annotations, each a JSON object without ids.
std::string coco_image(const LabelledFrame& labelled, const std::string& file_name);
std::vector<std::string> coco_annotations(const LabelledFrame& labelled);

/// COCO's "categories", as `dmise export --to coco` has them.
std::string coco_categories();

}  // namespace dmise
