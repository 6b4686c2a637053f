#include "nodes/runtime/protocol/kept_frames.h"

#include <algorithm>

#include "core/base/error.h"
#include "nodes/wire/state_codec.h"

namespace dmise {

void KeptFrames::when_changed(std::function<void()> changed) {
  const std::lock_guard lock(mutex_);
  changed_ = std::move(changed);
}

void KeptFrames::add(const FrameReport& report, std::function<FrameBytes()> load,
                     std::size_t held_bytes) {
  std::string payload = load ? encode(State(report)).payload : "";
  const std::lock_guard lock(mutex_);
  ++made_;
  if (!load) return;
  Kept added{report.frame, made_, std::move(payload), std::move(load), held_bytes};
  if (!kept_.empty() && added.number <= kept_.back().number)
    throw Error("frame " + std::to_string(added.number) + " is not later than those kept");
  kept_.push_back(std::move(added));
  held_bytes_ += held_bytes;
  while (kept_.size() > max_frames || (held_bytes_ > max_bytes && kept_.size() > 1)) {
    held_bytes_ -= kept_.front().held_bytes;
    kept_.pop_front();
  }
  changed_();
}

void KeptFrames::end() {
  const std::lock_guard lock(mutex_);
  over_ = true;
  changed_();
}

const KeptFrames::Kept* KeptFrames::wanted_by(const v1::FrameRequest& request) const {
  const auto first_from = [this](std::uint64_t number) -> const Kept* {
    const auto at = std::ranges::lower_bound(kept_, number, {}, &Kept::number);
    return at == kept_.end() ? nullptr : &*at;
  };
  switch (request.which_case()) {
    case v1::FrameRequest::kFrame: {
      const Kept* found = first_from(request.frame());
      return found && found->number == request.frame() ? found : nullptr;
    }
    case v1::FrameRequest::kNextAfter:
      return first_from(std::uint64_t(request.next_after()) + 1);
    case v1::FrameRequest::kLatestAfter:
      return first_from(std::uint64_t(request.latest_after()) + 1) ? &kept_.back() : nullptr;
    case v1::FrameRequest::WHICH_NOT_SET:
      break;
  }
  return nullptr;
}

std::optional<KeptFrames::Answer> KeptFrames::answer(const v1::FrameRequest& request,
                                                     std::uint64_t run_id) const {
  Answer answer;
  std::function<FrameBytes()> load;
  {
    const std::lock_guard lock(mutex_);
    const Kept* found = wanted_by(request);
    const bool waits = request.which_case() == v1::FrameRequest::kNextAfter ||
                       request.which_case() == v1::FrameRequest::kLatestAfter;
    if (!found && waits && !over_) return std::nullopt;
    answer.head.set_run_id(run_id);
    answer.head.set_sensor(sensor_);
    if (!kept_.empty()) {
      answer.head.set_oldest_frame(kept_.front().number);
      answer.head.set_newest_frame(kept_.back().number);
    }
    answer.head.set_status(waits ? v1::FrameAnswer::STATUS_OVER : v1::FrameAnswer::STATUS_NOT_KEPT);
    if (!found) return answer;
    answer.head.set_sequence(found->sequence);
    answer.head.mutable_report()->ParseFromString(found->report);
    load = found->load;
  }
  try {
    answer.fits = load();
    answer.head.set_status(v1::FrameAnswer::STATUS_SENT);
  } catch (const Error&) {  // its file was removed; the report says which it is
    answer.head.set_status(v1::FrameAnswer::STATUS_NOT_KEPT);
  }
  return answer;
}

}  // namespace dmise
