#include "nodes/wire/state_codec.h"

#include "nodes/wire/codecs.h"
#include "nodes/wire/state_rules.h"

namespace dmise {

Encoded encode(const State& state) {
  check(state);
  return std::visit([](const auto& s) { return encode_body(s); }, state);
}

State decode(MessageKind kind, std::string_view payload, std::string_view arrays) {
  if (kind != MessageKind::object_states && kind != MessageKind::object_roster && !arrays.empty())
    throw Refused(Refusal::payload, "arrays that this kind does not have");
  State state = [&]() -> State {
    switch (kind) {
      case MessageKind::object_roster:
        return decode_roster(payload, arrays);
      case MessageKind::object_states:
        return decode_states(payload, arrays);
      case MessageKind::environment_state:
        return decode_environment(payload);
      case MessageKind::site_state:
        return decode_site(payload);
      case MessageKind::frame_report:
        return decode_report(payload);
      case MessageKind::detection_set:
        return decode_detections(payload);
      case MessageKind::truth_set:
        return decode_truths(payload);
      case MessageKind::track_set:
        return decode_tracks(payload);
      case MessageKind::task_set:
        return decode_tasks(payload);
      case MessageKind::probe:
      case MessageKind::watermark:
      case MessageKind::position:
        break;
    }
    throw Refused(Refusal::payload, "this kind carries no state");
  }();
  check(state);
  return state;
}

}  // namespace dmise
