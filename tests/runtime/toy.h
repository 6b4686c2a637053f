#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/sim/participant.h"

// Small participants for tests of the network: what they publish is a function of what they
// receive, and the recorder keeps every byte.
namespace dmise::test {

/// Publishes a roster in tick 0 and states in every tick.
class ToyOrbit : public Participant {
 public:
  explicit ToyOrbit(std::size_t objects = 20, std::int64_t tick_ns = 1'000'000'000)
      : objects_(objects), tick_ns_(tick_ns) {}
  std::string name() const override { return "orbit"; }
  std::vector<std::string> produces() const override { return {objects_topic}; }
  std::vector<std::string> consumes() const override { return {}; }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;
  std::vector<Message> resume(Tick tick, std::span<const Message> past) override;

 private:
  Message roster(Tick tick) const;

  std::size_t objects_;
  std::int64_t tick_ns_;
};

/// Publishes detections (none, one or two sets a tick) and truth made from the states.
class ToyCamera : public Participant {
 public:
  explicit ToyCamera(std::string name) : name_(std::move(name)) {}
  std::string name() const override { return name_; }
  std::vector<std::string> produces() const override {
    return {detection_prefix + name_, truth_prefix + name_};
  }
  std::vector<std::string> consumes() const override { return {objects_topic}; }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;

  std::vector<Message> resume(Tick tick, std::span<const Message> past) override;

  std::function<void(Tick)> on_step;  // may be empty

 private:
  std::string name_;
  std::uint32_t frame_ = 0;
};

/// Keeps everything that the cameras say, in the order in which it is handed over; or only the last
/// tick's, in runs without end.
class ToyRecorder : public Participant {
 public:
  explicit ToyRecorder(std::vector<std::string> cameras, bool keep_all = true)
      : cameras_(std::move(cameras)), keep_all_(keep_all) {}
  std::string name() const override { return "recorder"; }
  std::vector<std::string> produces() const override { return {}; }
  std::vector<std::string> consumes() const override;
  bool needs(const std::string&) const override { return false; }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;

  const std::string& record() const { return record_; }

 private:
  std::vector<std::string> cameras_;
  bool keep_all_;
  std::string record_;
};

/// Runs participants in this process, in the given order within each tick: the reference for what a
/// network of them must give.
void drive(const std::vector<Participant*>& participants, Tick last_tick);

}  // namespace dmise::test
