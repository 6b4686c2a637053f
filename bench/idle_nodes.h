#pragma once
#include <string>
#include <vector>

#include "bench/children.h"
#include "core/sim/participant.h"

namespace dmise {

/// A node that does nothing, so that only the clock is measured.
class Idle : public Participant {
 public:
  explicit Idle(int index) : name_("node-" + std::to_string(index)) {}
  std::string name() const override { return name_; }
  std::vector<std::string> produces() const override { return {}; }
  std::vector<std::string> consumes() const override { return {}; }
  std::vector<Message> step(Tick, std::span<const Message>) override { return {}; }

 private:
  std::string name_;
};

}  // namespace dmise
