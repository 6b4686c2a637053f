#include "clients/cpp/said_states.h"

#include <string>

#include "core/base/error.h"
#include "core/orbit/motion.h"
#include "core/sim/columns.h"

namespace dmise {
namespace {

void add_attitudes(const ObjectStateList& said, const v1::OwnNodeBegin& begin,
                   ObjectStates& states) {
  for (std::uint32_t i = 0; i < states.count; ++i)
    if (begin.objects(int(i)).turned()) states.attitude_object.push_back(i);
  const std::size_t m = states.attitude_object.size();
  states.gcrs_from_body.assign(4 * m, 0.0);
  states.attitude_rate_rad_per_s.assign(3 * m, 0.0);
  for (std::size_t k = 0; k < m; ++k) {
    const std::uint32_t i = states.attitude_object[k];
    if (!said[i]) continue;
    if (!said[i]->attitude)
      throw Error("attitude: is needed of " + begin.objects(int(i)).name() +
                  ", which the node turns");
    const auto& [q, rate_rad_per_s] = *said[i]->attitude;
    set_column(states.gcrs_from_body, m, k, {q.w, q.x, q.y, q.z});
    set_column(states.attitude_rate_rad_per_s, m, k, rate_rad_per_s);
  }
}

}  // namespace

ObjectStates said_states(const ObjectStateList& said, const v1::OwnNodeBegin& begin, Tick tick,
                         SimTime time) {
  const std::size_t n = std::size_t(begin.objects_size());
  if (said.size() != n)
    throw Error("its model says " + std::to_string(said.size()) + " states, of " +
                std::to_string(n) + " objects");
  ObjectStates states{.tick = tick, .time = time, .count = n};
  for (auto* rows : {&states.position_m, &states.slope_m_per_s, &states.velocity_m_per_s})
    rows->assign(3 * n, 0.0);
  states.code.assign(n, std::uint8_t(MotionCode::untold));
  for (std::size_t i = 0; i < n; ++i) {
    if (!said[i]) continue;
    const Vec<Gcrs>& velocity_m_per_s = said[i]->velocity_m_per_s;
    states.code[i] = 0;
    set_column(states.position_m, n, i, said[i]->position_m);
    set_column(states.slope_m_per_s, n, i, said[i]->slope_m_per_s.value_or(velocity_m_per_s));
    set_column(states.velocity_m_per_s, n, i, velocity_m_per_s);
    if (!said[i]->albedo) continue;
    states.albedo.resize(n, roster_albedo);
    states.albedo[i] = *said[i]->albedo;
  }
  add_attitudes(said, begin, states);
  return states;
}

}  // namespace dmise
