#pragma once
#include "dmise/v1/node.pb.h"
#include "nodes/runtime/process/process_memory.h"
#include "nodes/runtime/protocol/time_split.h"

namespace dmise {

inline void put(v1::TimeSplit* message, const TimeSplit& times) {
  message->set_compute_s(times.compute_s);
  message->set_messaging_s(times.messaging_s);
  message->set_waiting_s(times.waiting_s);
  message->set_frames(times.frames);
  message->set_detections(times.detections);
  message->set_start_s(times.start_s);
  message->set_peak_resident_bytes(times.peak_resident_bytes);
  message->set_private_bytes(times.private_bytes);
}
inline void put(v1::TimeSplit* message, const ProcessMemory& memory) {
  message->set_peak_resident_bytes(memory.peak_resident_bytes);
  message->set_private_bytes(memory.private_bytes);
}
inline TimeSplit take(const v1::TimeSplit& message) {
  return {message.compute_s(),           message.messaging_s(),
          message.waiting_s(),           message.frames(),
          message.detections(),          message.start_s(),
          message.peak_resident_bytes(), message.private_bytes()};
}

}  // namespace dmise
