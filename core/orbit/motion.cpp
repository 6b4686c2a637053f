#include "core/orbit/motion.h"

#include "core/base/error.h"

namespace dmise {

namespace {

struct ToGcrs {
  const EarthOrientation& earth;
  SimTime t;

  MotionState<Gcrs> operator()(const MotionState<Gcrs>& s) const { return s; }
  MotionState<Gcrs> operator()(const MotionState<Itrs>& s) const {
    const auto gcrs_from_itrs = earth.itrs_from_gcrs(t).inverse();
    return {gcrs_from_itrs * s.position_m,
            gcrs_from_itrs * s.velocity_m_per_s + earth.velocity_of_fixed_point(s.position_m, t)};
  }
  MotionState<Gcrs> operator()(const MotionState<Teme>& s) const {
    const auto gcrs_from_teme = earth.gcrs_from_teme(t);
    return {gcrs_from_teme * s.position_m, gcrs_from_teme * s.velocity_m_per_s};
  }
};

}  // namespace

FramedState state_at(const NodeMotion& motion, const Tai&) {
  throw Error("only node " + motion.node + " knows where its objects are");
}

MotionState<Gcrs> in_gcrs(const FramedState& state, const EarthOrientation& earth, SimTime t) {
  return std::visit(ToGcrs{earth, t}, state);
}

std::string_view describe(MotionCode code) {
  switch (code) {
    case MotionCode::outside_span:
      return "outside the span of its trajectory";
    case MotionCode::underground:
      return "its path enters the Earth";
    case MotionCode::untold:
      return "its node gives it no state";
    case MotionCode::ok:
      break;
  }
  return "has a state";
}

}  // namespace dmise
