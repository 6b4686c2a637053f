#include "nodes/own/own_model.h"

#include <utility>

#include "core/base/printable.h"
#include "nodes/wire/content_digest.h"
#include "nodes/wire/state_codec.h"

namespace dmise {
namespace {

v1::OwnNodeRequest request_of(const v1::OwnNodeStep& step) {
  v1::OwnNodeRequest request;
  *request.mutable_step() = step;
  return request;
}

}  // namespace

OwnModel::Answer OwnModel::answer_in(std::vector<std::string_view> frames,
                                     std::shared_ptr<const void> owner) {
  Answer answer{.head = {}, .frames = std::move(frames), .owner = std::move(owner)};
  const std::string_view head = answer.frames.empty() ? "" : answer.frames[0];
  if (!answer.head.ParseFromArray(head.data(), int(head.size())) ||
      answer.head.body_case() == v1::OwnNodeAnswer::BODY_NOT_SET)
    throw Error("what its program says is no answer (" + std::to_string(head.size()) + " bytes)");
  if (answer.head.has_failed()) throw Error(printable(answer.head.failed()));
  return answer;
}

std::optional<OwnModel::Answer> OwnModel::heard(const char* what,
                                                v1::OwnNodeAnswer::BodyCase wanted,
                                                std::size_t frames) {
  auto got = answer();
  if (!got) return std::nullopt;
  if (got->head.body_case() != wanted)
    throw Error(std::string("its program answers a ") + what + " by something else");
  if (got->frames.size() != frames)
    throw Error("its program answers in " + std::to_string(got->frames.size()) +
                " frames instead of " + std::to_string(frames));
  return got;
}

bool OwnModel::ask(const v1::OwnNodeStep& step, const EnvironmentState& environment) {
  const std::string payload = encode(environment).payload;
  const std::string_view more[]{payload};
  return send(request_of(step), more);
}

bool OwnModel::ask_ahead(const v1::OwnNodeStep& step, const EnvironmentState& environment) {
  const std::string payload = encode(environment).payload;
  const std::string_view more[]{payload};
  return send_ahead(request_of(step), more);
}

std::optional<OwnModel::Stepped> OwnModel::stepped() {
  auto got = heard("step", v1::OwnNodeAnswer::kStepped, 3);
  if (!got) return std::nullopt;
  const auto& frames = got->frames;
  Stepped stepped;
  stepped.states = std::get<ObjectStates>(decode(MessageKind::object_states, frames[1], frames[2]));
  stepped.digest = content_digest(MessageKind::object_states, frames[1], frames[2]);
  if (got->head.stepped().has_checkpoint())
    stepped.checkpoint = std::move(*got->head.mutable_stepped()->mutable_checkpoint());
  return stepped;
}

std::optional<OwnModel::Answer> OwnModel::exchange(const v1::OwnNodeRequest& request, Frames more,
                                                   const char* what,
                                                   v1::OwnNodeAnswer::BodyCase wanted,
                                                   std::size_t frames) {
  if (!send(request, more)) return std::nullopt;
  return heard(what, wanted, frames);
}

std::optional<v1::OwnNodeFound> OwnModel::find(const v1::OwnNodeFrame& frame,
                                               std::string_view counts) {
  v1::OwnNodeRequest request;
  *request.mutable_frame() = frame;
  auto got = exchange(request, {&counts, 1}, "frame", v1::OwnNodeAnswer::kFound, 1);
  if (!got) return std::nullopt;
  return std::move(*got->head.mutable_found());
}

std::optional<v1::OwnNodeObserved> OwnModel::observe(const v1::OwnNodeObserve& exposure,
                                                     Frames more) {
  v1::OwnNodeRequest request;
  *request.mutable_observe() = exposure;
  auto got = exchange(request, more, "frame", v1::OwnNodeAnswer::kObserved, 1);
  if (!got) return std::nullopt;
  return std::move(*got->head.mutable_observed());
}

std::optional<OwnModel::Tracked> OwnModel::track(const v1::OwnNodeTrack& track, Frames exposures) {
  v1::OwnNodeRequest request;
  *request.mutable_track() = track;
  auto got = exchange(request, exposures, "tick", v1::OwnNodeAnswer::kTracked, 2);
  if (!got) return std::nullopt;
  v1::OwnNodeTracked& head = *got->head.mutable_tracked();
  const std::string_view set = got->frames[1];
  Tracked tracked;
  tracked.tracks = std::get<TrackSet>(decode(MessageKind::track_set, set, {}));
  if (head.has_checkpoint()) tracked.checkpoint = std::move(*head.mutable_checkpoint());
  head.clear_checkpoint();
  tracked.digest = content_digest(MessageKind::track_set, set, head.SerializeAsString());
  if (head.has_points()) tracked.points = std::move(*head.mutable_points());
  return tracked;
}

}  // namespace dmise
