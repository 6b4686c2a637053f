#pragma once
#include "dmise/v1/node.pb.h"
#include "nodes/runtime/protocol/time_split.h"

namespace dmise {

inline void put(v1::TimeSplit* message, const TimeSplit& times) {
  message->set_compute_s(times.compute_s);
  message->set_messaging_s(times.messaging_s);
  message->set_waiting_s(times.waiting_s);
  message->set_frames(times.frames);
  message->set_detections(times.detections);
}
inline TimeSplit take(const v1::TimeSplit& message) {
  return {message.compute_s(), message.messaging_s(), message.waiting_s(), message.frames(),
          message.detections()};
}

}  // namespace dmise
