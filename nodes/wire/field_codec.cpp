#include "dmise/v1/detection.pb.h"
#include "dmise/v1/environment.pb.h"
#include "dmise/v1/frame.pb.h"
#include "dmise/v1/task.pb.h"
#include "dmise/v1/track.pb.h"
#include "nodes/wire/codecs.h"
#include "nodes/wire/product_message.h"
#include "nodes/wire/state_fields.h"

namespace dmise {
namespace {

template <class M, class State>
Encoded encoded(MessageKind kind, const State& state) {
  M message;
  put_product(message, state);
  return {kind, message.SerializeAsString(), {}};
}

}  // namespace

Encoded encode_body(const EnvironmentState& s) {
  return encoded<v1::EnvironmentState>(MessageKind::environment_state, s);
}
EnvironmentState decode_environment(std::string_view payload) {
  return take_product<EnvironmentState>(parse<v1::EnvironmentState>(payload));
}

Encoded encode_body(const SiteState& s) {
  return encoded<v1::SiteState>(MessageKind::site_state, s);
}
SiteState decode_site(std::string_view payload) {
  return take_product<SiteState>(parse<v1::SiteState>(payload));
}

Encoded encode_body(const FrameReport& s) {
  return encoded<v1::FrameReport>(MessageKind::frame_report, s);
}
FrameReport decode_report(std::string_view payload) {
  return take_product<FrameReport>(parse<v1::FrameReport>(payload));
}

Encoded encode_body(const DetectionSet& s) {
  return encoded<v1::DetectionSet>(MessageKind::detection_set, s);
}
DetectionSet decode_detections(std::string_view payload) {
  return take_product<DetectionSet>(parse<v1::DetectionSet>(payload));
}

Encoded encode_body(const TruthSet& s) { return encoded<v1::TruthSet>(MessageKind::truth_set, s); }
TruthSet decode_truths(std::string_view payload) {
  return take_product<TruthSet>(parse<v1::TruthSet>(payload));
}

Encoded encode_body(const TrackSet& s) { return encoded<v1::TrackSet>(MessageKind::track_set, s); }
TrackSet decode_tracks(std::string_view payload) {
  return take_product<TrackSet>(parse<v1::TrackSet>(payload));
}

Encoded encode_body(const TaskSet& s) { return encoded<v1::TaskSet>(MessageKind::task_set, s); }
TaskSet decode_tasks(std::string_view payload) {
  return take_product<TaskSet>(parse<v1::TaskSet>(payload));
}

}  // namespace dmise
