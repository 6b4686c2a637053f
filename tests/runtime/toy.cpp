#include "tests/runtime/toy.h"

#include <algorithm>
#include <cmath>

#include "nodes/wire/state_codec.h"

namespace dmise::test {

Message ToyOrbit::roster(Tick tick) const {
  ObjectRoster roster;
  for (std::size_t i = 0; i < objects_; ++i)
    roster.objects.push_back({.catalogue_number = std::uint32_t(i + 1),
                              .name = "OBJECT " + std::to_string(i),
                              .designator = "98067A"});
  return {objects_topic, tick, std::make_shared<const State>(std::move(roster))};
}

std::vector<Message> ToyOrbit::resume(Tick tick, std::span<const Message>) {
  if (tick == 0) return {};
  return {roster(tick)};
}

std::vector<Message> ToyOrbit::step(Tick tick, std::span<const Message>) {
  std::vector<Message> messages;
  if (tick == 0) messages.push_back(roster(tick));
  ObjectStates states;
  states.tick = tick;
  states.time = {tick * tick_ns_};
  states.count = objects_;
  for (std::size_t i = 0; i < 3 * objects_; ++i) {
    const double x = double(i) + 0.1 * double(tick);
    states.position_m.push_back(7e6 * std::sin(x));
    states.slope_m_per_s.push_back(7e3 * std::cos(x));
    states.velocity_m_per_s.push_back(i % 7 == 0 ? -0.0 : 7e3 * std::cos(x + 1e-9));
  }
  states.code.assign(objects_, 0);
  messages.push_back({objects_topic, tick, std::make_shared<const State>(std::move(states))});
  return messages;
}

std::vector<Message> ToyCamera::resume(Tick tick, std::span<const Message>) {
  frame_ = 0;
  for (Tick before = 0; before < tick; ++before) frame_ += std::uint32_t(before % 3);
  return {};
}

std::vector<Message> ToyCamera::step(Tick tick, std::span<const Message> inputs) {
  if (on_step) on_step(tick);
  std::vector<Message> messages;
  const auto& states = std::get<ObjectStates>(*inputs.back().state);
  for (int set = 0; set < int(tick % 3); ++set) {
    DetectionSet found{.sensor = name_, .frame = ++frame_, .detections = {}};
    TruthSet truth{.sensor = name_, .frame = frame_, .truths = {}};
    for (std::size_t i = 0; i < std::min<std::size_t>(states.count, std::size_t(tick % 5)); ++i) {
      const auto [ra_rad, dec_rad] = to_spherical(states.position(i));
      found.detections.push_back(
          {.id = name_ + "/" + std::to_string(frame_) + "/" + std::to_string(i),
           .sensor = name_,
           .frame = frame_,
           .index = std::uint32_t(i),
           .time = states.time,
           .ra_rad = ra_rad,
           .dec_rad = dec_rad});
      truth.truths.push_back({.sensor = name_,
                              .frame = frame_,
                              .name = "OBJECT " + std::to_string(i),
                              .true_range_m = norm(states.position(i))});
    }
    messages.push_back(
        {detection_prefix + name_, tick, std::make_shared<const State>(std::move(found))});
    messages.push_back(
        {truth_prefix + name_, tick, std::make_shared<const State>(std::move(truth))});
  }
  return messages;
}

std::vector<std::string> ToyRecorder::consumes() const {
  std::vector<std::string> topics;
  for (const std::string& camera : cameras_) {
    topics.push_back(detection_prefix + camera);
    topics.push_back(truth_prefix + camera);
  }
  return topics;
}

std::vector<Message> ToyRecorder::step(Tick tick, std::span<const Message> inputs) {
  if (!keep_all_) record_.clear();
  record_ += "tick " + std::to_string(tick) + "\n";
  for (const Message& message : inputs) {
    const Encoded body = encode(*message.state);
    record_ += message.topic + " " + std::to_string(message.tick) + " " + body.payload +
               body.arrays + "\n";
  }
  return {};
}

void drive(const std::vector<Participant*>& participants, Tick last_tick) {
  for (Tick tick = 0; tick <= last_tick; ++tick) {
    std::vector<Message> published;
    for (Participant* participant : participants) {
      std::vector<Message> inputs;
      for (const std::string& topic : participant->consumes())
        std::copy_if(published.begin(), published.end(), std::back_inserter(inputs),
                     [&](const Message& m) { return m.topic == topic; });
      for (Message& message : participant->step(tick, inputs))
        published.push_back(std::move(message));
    }
  }
}

}  // namespace dmise::test
