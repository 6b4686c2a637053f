// A walk in steps of the seed and the tick, by the library for users' programs. With the option
// `fault` it answers tick 3 wrongly. Detections push it.
#include <cmath>
#include <limits>
#include <stdexcept>

#include "clients/cpp/node.h"

namespace {

struct Walk {
  explicit Walk(const dmise::ActorTask& task) : fault(task.options.value("fault", "")) {}

  std::vector<std::optional<dmise::ObjectState>> step(const dmise::ActorWorld& world) {
    place_m += double(world.task.seed) + std::sqrt(double(world.tick));
    for (const dmise::Message& message : world.heard)
      place_m += 100.0 * std::get<dmise::DetectionSet>(*message.state).frame;
    std::vector<std::optional<dmise::ObjectState>> states(world.task.objects.size());
    for (std::size_t i = 0; i < states.size(); i += 2)
      states[i] = {.position_m = {place_m, 7e6, double(i)},
                   .velocity_m_per_s = {1, 2, 3},
                   .attitude = dmise::AttitudeState{{0, 1, 0, 0}, {0, 0, 0.5}}};
    if (world.tick == 3) answer_wrongly(states);
    return states;
  }
  void answer_wrongly(std::vector<std::optional<dmise::ObjectState>>& states) const {
    if (fault == "throws") throw std::runtime_error("no fuel");
    if (fault == "throws_a_number") throw 7;
    if (fault == "nan") states[0]->position_m.y = std::numeric_limits<double>::quiet_NaN();
    if (fault == "too_many") states.resize(5);
    if (fault == "no_attitude") states[0]->attitude.reset();
  }
  std::string checkpoint() const { return std::to_string(place_m); }
  void restore(std::string_view checkpoint) { place_m = std::stod(std::string(checkpoint)); }

  std::string fault;
  double place_m = 0.0;
};

}  // namespace

int main(int argc, char** argv) { return dmise::node_main<Walk>(argc, argv); }
