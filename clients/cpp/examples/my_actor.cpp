// Moves an object about the Earth through the position and velocity that the scenario's options
// give of its start.
#include <dmise/node.h>

#include "core/orbit/motion.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"

namespace {

class MyActor {
 public:
  explicit MyActor(const dmise::ActorTask& task) : clock_(dmise::parse_utc(task.start_utc)) {
    motion_ = {.epoch = clock_.tai({0}),
               .state = {task.vector("position_m"), task.vector("velocity_m_per_s")}};
  }

  dmise::ObjectState step(const dmise::ActorWorld& world) const {
    const auto state = dmise::state_at(motion_, clock_.tai(world.time));
    const auto& [position_m, velocity_m_per_s] = std::get<dmise::MotionState<dmise::Gcrs>>(state);
    return {.position_m = position_m, .velocity_m_per_s = velocity_m_per_s};
  }

 private:
  dmise::Clock clock_;
  dmise::TwoBodyMotion motion_;
};

}  // namespace

int main(int argc, char** argv) { return dmise::node_main<MyActor>(argc, argv); }
