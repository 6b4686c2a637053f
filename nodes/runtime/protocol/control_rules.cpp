#include "nodes/runtime/protocol/control_rules.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/base/sim_time.h"

namespace dmise {
namespace {

using Fault = std::optional<std::string>;

constexpr std::int64_t max_ticks = std::int64_t(1) << 40;
constexpr std::size_t longest_name = 256;
constexpr int max_topics = 4096;

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

bool is_text(const std::string& text) {
  return text.size() <= longest_name && std::none_of(text.begin(), text.end(), is_control);
}
bool is_name(const std::string& text) { return !text.empty() && is_text(text); }

template <class Texts>
bool are_names(const Texts& texts) {
  return texts.size() <= max_topics && std::all_of(texts.begin(), texts.end(), is_name);
}

bool is_tick(std::int64_t tick) { return tick >= 0 && tick <= max_ticks; }
bool is_tick_or_none(std::int64_t tick) { return tick >= -1 && tick <= max_ticks; }
bool is_count(std::uint64_t ticks) { return ticks <= std::uint64_t(max_ticks); }
bool is_duration(double s, double limit_s) { return s >= 0.0 && s <= limit_s; }  // false for NaN

Fault unless(bool holds, const char* fault) { return holds ? std::nullopt : Fault(fault); }

bool good(const v1::TimeSplit& times) {
  constexpr double a_lifetime_s = 1e10;
  return is_duration(times.compute_s(), a_lifetime_s) &&
         is_duration(times.messaging_s(), a_lifetime_s) &&
         is_duration(times.waiting_s(), a_lifetime_s) && is_duration(times.start_s(), a_lifetime_s);
}

bool good(const v1::TopicTally& tally) { return is_name(tally.topic()) && is_tick(tally.tick()); }

bool good(const v1::ClosedTopic& of) { return is_name(of.topic()) && is_tick(of.from_tick()); }

bool good(const v1::TopicSchedule& of) {
  return is_name(of.topic()) && of.period_ticks() >= 1 && is_count(of.period_ticks()) &&
         is_count(of.offset_ticks());
}

bool good(const v1::TopicDelay& of) {
  return is_name(of.topic()) && of.delay_ticks() >= 1 && is_count(of.delay_ticks());
}

bool good(const v1::NodeBeat& node) {
  return is_name(node.name()) && is_tick_or_none(node.done_tick()) && good(node.times());
}

bool good(const v1::NodeStart& start) {
  return is_name(start.name()) && is_tick(start.resume_tick()) && is_tick(start.from_tick()) &&
         start.from_tick() <= start.resume_tick();
}

bool good(const v1::Publisher& publisher);

template <class Items>
bool all_good(const Items& items) {
  return std::all_of(items.begin(), items.end(), [](const auto& item) { return good(item); });
}

bool good(const v1::Broker& broker) {
  return is_text(broker.publish_endpoint()) && is_text(broker.subscribe_endpoint()) &&
         is_text(broker.observe_endpoint()) && is_text(broker.password());
}

Fault fault_in(const v1::Join& join) {
  if (!is_name(join.name()))
    return "join: the name must have 1 to 256 bytes and no control characters";
  if (!are_names(join.produces()) || !are_names(join.produces_direct()) ||
      !are_names(join.consumes()))
    return "join: topics must be names, at most 4096";
  if (!is_text(join.host())) return "join: invalid host name";
  if (!is_text(join.direct_endpoint()) || !is_text(join.resend_endpoint()) ||
      !is_text(join.frames_endpoint()) || !good(join.broker()))
    return "join: invalid address";
  return unless(is_count(join.look_back_ticks()) && is_count(join.period_ticks()) &&
                    is_count(join.offset_ticks()) && join.schedules_size() <= max_topics &&
                    all_good(join.schedules()) && join.delays_size() <= max_topics &&
                    all_good(join.delays()),
                "join: period, offset, look-back and delays must be ticks of a run");
}

bool good(const v1::Publisher& publisher) {
  return is_name(publisher.name()) && are_names(publisher.topics()) &&
         are_names(publisher.direct_topics()) && is_text(publisher.direct_endpoint()) &&
         is_text(publisher.resend_endpoint()) && is_text(publisher.frames_endpoint()) &&
         is_count(publisher.keep_ticks()) && is_count(publisher.period_ticks()) &&
         is_count(publisher.offset_ticks()) && publisher.schedules_size() <= max_topics &&
         all_good(publisher.schedules());
}

Fault fault_in(const v1::Welcome& welcome) {
  const std::int64_t tick_ns = welcome.tick_ns(), last_tick = welcome.last_tick();
  if (tick_ns < 1 || !is_tick(last_tick) ||
      last_tick > std::numeric_limits<std::int64_t>::max() / tick_ns - 1)
    return "welcome: invalid number or length of ticks";
  if (welcome.window_ticks() < 1 || welcome.window_ticks() > 1'000'000)
    return "welcome: window_ticks must be 1 to 1000000";
  return unless(welcome.heartbeat_s() > 0.0 && is_duration(welcome.heartbeat_s(), 3600.0) &&
                    welcome.silent_after_s() > 0.0 && is_duration(welcome.silent_after_s(), 1e6) &&
                    is_text(welcome.tick_endpoint()) && is_text(welcome.name()) &&
                    is_tick(welcome.resume_tick()) && is_duration(welcome.progress_after_s(), 1e6),
                "welcome: invalid heartbeat_s, silent_after_s or tick_endpoint");
}

Fault fault_in(const v1::Topology& topology) {
  return unless(are_names(topology.reported()) && all_good(topology.starts()) &&
                    all_good(topology.publishers()) && is_text(topology.publish_endpoint()) &&
                    is_text(topology.subscribe_endpoint()) && is_text(topology.broker_password()) &&
                    is_tick(topology.resume_tick()) && is_tick(topology.from_tick()) &&
                    topology.from_tick() <= topology.resume_tick(),
                "topology: invalid publisher, address or tick");
}

}  // namespace

std::optional<std::string> fault_of(const v1::NodeMessage& message) {
  switch (message.body_case()) {
    case v1::NodeMessage::kJoin:
      return fault_in(message.join());
    case v1::NodeMessage::kDone:
      return unless(is_tick(message.done().tick()) &&
                        message.done().published_size() <= max_topics &&
                        all_good(message.done().published()),
                    "done: invalid tick or topic");
    case v1::NodeMessage::kHeartbeat:
      return unless(is_name(message.heartbeat().name()) && good(message.heartbeat().times()) &&
                        all_good(message.heartbeat().nodes()) &&
                        are_names(message.heartbeat().holding()),
                    "heartbeat: invalid name or time");
    case v1::NodeMessage::kLeave:
      return unless(good(message.leave().times()) && all_good(message.leave().nodes()) &&
                        is_text(message.leave().cause()),
                    "leave: invalid time or cause");
    case v1::NodeMessage::kNodeNews:
      return unless(
          is_name(message.node_news().name()) && is_tick_or_none(message.node_news().done_tick()),
          "node news: invalid name or tick");
    case v1::NodeMessage::kControl:
      return unless(v1::Control::Action_IsValid(message.control().action()) &&
                        message.control().action() != v1::Control::ACTION_UNSPECIFIED &&
                        is_tick_or_none(message.control().tick()) &&
                        is_duration(message.control().factor(), max_pace_factor),
                    "control: invalid action, tick or factor");
    case v1::NodeMessage::BODY_NOT_SET:
      return "has no body";
    default:
      return std::nullopt;
  }
}

std::optional<std::string> fault_of(const v1::Grant& grant) {
  return unless(
      is_tick_or_none(grant.tick()) && all_good(grant.published()) && all_good(grant.closed()),
      "grant: invalid tick or topic");
}

std::optional<std::string> fault_of(const v1::MasterMessage& message) {
  switch (message.body_case()) {
    case v1::MasterMessage::kWelcome:
      return fault_in(message.welcome());
    case v1::MasterMessage::kTopology:
      return fault_in(message.topology());
    case v1::MasterMessage::kGrant:
      return fault_of(message.grant());
    case v1::MasterMessage::BODY_NOT_SET:
      return "has no body";
    default:
      return std::nullopt;
  }
}

std::optional<std::string> fault_of(const v1::ResendRequest& request) {
  return unless(is_name(request.topic()) && is_tick(request.from_tick()),
                "resend request: invalid topic or tick");
}

std::optional<std::string> fault_of(const v1::FrameRequest& request) {
  switch (request.which_case()) {
    case v1::FrameRequest::kFrame:
      return unless(request.frame() >= 1, "frame request: frames count from 1");
    case v1::FrameRequest::WHICH_NOT_SET:
      return "frame request: asks for nothing";
    default:
      return std::nullopt;
  }
}

}  // namespace dmise
