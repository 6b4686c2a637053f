#pragma once
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/propagation/object_states.h"
#include "core/sim/message.h"
#include "sensors/objects/objects_in_field.h"

namespace dmise {

/// The objects of a roster with their motion models.
struct PropagatedObjects {
  PropagatedObjects(const ObjectRoster& roster, const std::vector<OwnObject>& own, Clock clock,
                    const Ellipsoid& ellipsoid, const ObjectModels& models = {});

  ObjectPopulation population;
  std::size_t from_catalogues;  // number of the first objects, those of catalogues
  Threads threads{1};
  StateSource source;
};

/// The objects of a published roster. The sensors of one process share them.
std::shared_ptr<const PropagatedObjects> propagated_objects(
    const std::shared_ptr<const State>& roster, const std::vector<OwnObject>& own,
    const Clock& clock, const Ellipsoid& ellipsoid, const ObjectModels& models = {});

/// States that a sensor propagates itself, exposure by exposure: equal to the published states to
/// the bit, of the objects that may be in the field alone. Those that a node moves are as it told.
class StatesInField {
 public:
  StatesInField(std::shared_ptr<const PropagatedObjects> objects, SimTime tick_length);

  /// Takes what nodes of the user's say of their objects; false for any other message.
  bool tell(const Message& message) { return told_.add(message); }
  void forget_before(Tick tick) { told_.forget_before(tick); }

  /// Returns `window`, which has ticks without states, with those that the exposure needs: of
  /// platform, target and all objects that may be in the field.
  StateWindow around(const StateWindow& window, const SensorConfig& sensor,
                     const FrameTimes& commanded, std::uint64_t seed = 1);

 private:
  const StateInstants& instants(const StateWindow& window, Tick tick);
  RoughPlaces& rough_places(SimTime t);

  std::shared_ptr<const PropagatedObjects> objects_;
  SimTime tick_length_;
  ActorStates told_;
  std::map<Tick, StateInstants> instants_;  // for ticks of the last exposure
  std::optional<RoughPlaces> rough_;
};

}  // namespace dmise
