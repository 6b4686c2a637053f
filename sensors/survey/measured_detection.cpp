#include "sensors/survey/detection_model.h"

namespace dmise {

const DetectionModel& measured_detection_model() {
  static const DetectionModel model{.lengths = {{0.0, 19.95, 0.465},
                                                {4.0, 35.64, 0.530},
                                                {6.5, 21.41, 0.608},
                                                {10.0, 19.64, 0.686},
                                                {14.0, 10.12, 0.355},
                                                {24.0, 9.23, 0.368},
                                                {48.0, 7.37, 0.579},
                                                {96.0, 9.31, 0.162},
                                                {200.0, 7.67, 0.213}},
                                    .share = 0.9796};
  return model;
}

}  // namespace dmise
