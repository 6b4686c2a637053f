#include "core/config/place_deputies.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/config/make_clock.h"
#include "core/config/objects/named_motion.h"
#include "core/config/stated_motion.h"
#include "core/forces/proximity.h"

namespace dmise {
namespace {

constexpr double beyond_run_s = 300.0;     // about the run: light time, exposures
constexpr double max_eccentricity = 0.01;  // up to which a chief's orbit counts as a circle
constexpr double step_rad = 0.02;          // turn of the chief between states
constexpr double noted_part = 0.01;        // least error over distance that is warned of

struct Span {
  double from_s, to_s;
};

/// What the chief does in one span without a jump.
struct ChiefPath {
  StatedMotion::Model model;
  Span span;
};

/// Part of the spans of a chief's motion that is within `wanted`.
std::vector<ChiefPath> paths_of(const StatedMotion::Model& model, const Clock& clock, Span wanted) {
  const auto* motion = std::get_if<MotionModel>(&model);
  const auto* trajectory = motion ? std::get_if<Trajectory>(motion) : nullptr;
  if (!trajectory) return {{model, wanted}};
  const double shift_s = since_start_s(clock, trajectory->reference);
  std::vector<ChiefPath> paths;
  for (const OemSegment& segment : trajectory->segments) {
    const Span span{std::max(wanted.from_s, segment.usable_start_s + shift_s),
                    std::min(wanted.to_s, segment.usable_stop_s + shift_s)};
    if (span.from_s < span.to_s)
      paths.push_back(
          {MotionModel(Trajectory{trajectory->source, trajectory->reference, {segment}}), span});
  }
  return paths;
}

/// Places one object that moves near another.
class Deputy {
 public:
  Deputy(Scenario& scenario, OwnObject& object)
      : scenario_(scenario),
        object_(object),
        proximity_(*object.motion.proximity),
        clock_(make_clock(scenario)),
        end_s_(scenario.time_of(scenario.last_tick()).seconds()),
        chief_(chief_model()) {}

  void place() {
    chief_0_ = state_of_chief(StatedMotion(chief_, clock_), 0.0);
    check_orbit();
    Trajectory path{.source = "the motion of " + object_.name + " near " + proximity_.chief,
                    .reference = clock_.tai({0})};
    for (const ChiefPath& chief : paths_of(chief_, clock_, {-beyond_run_s, end_s_ + beyond_run_s}))
      add_segments(chief, path);
    if (path.segments.empty())
      throw ConfigError(proximity_.chief_where + ": has no path in the run, got " +
                        proximity_.chief);
    object_.motion.model = MotionModel(std::move(path));
    warn_of_corners();
    warn_of_first_order();
  }

 private:
  StatedMotion::Model chief_model() {
    try {
      auto model = motion_named(proximity_.chief, scenario_.own_objects, scenario_.objects);
      const auto* motion = std::get_if<MotionModel>(&model);
      if (motion && std::holds_alternative<NodeMotion>(*motion))
        throw Error("a node moves it during the run");
      if (const auto* conic = motion ? std::get_if<TwoBodyMotion>(motion) : nullptr)
        gm_m3_per_s2_ = conic->gm_m3_per_s2;
      return model;
    } catch (const Error& e) {
      throw ConfigError(proximity_.chief_where + ": " + e.what() + ", got " + proximity_.chief);
    }
  }

  /// In GCRS, or, by SGP4, in TEME, in which the deputy's states are then given.
  MotionState<Gcrs> state_of_chief(const StatedMotion& chief, double time_s) const {
    try {
      const MotionState<Gcrs> state = in_axes(chief.at(time_s), time_s);
      if (!(norm(state.position_m) > 0)) throw Error("it is at the Earth's centre");
      return state;
    } catch (const ConfigError&) {
      throw;
    } catch (const Error& e) {
      throw ConfigError(proximity_.chief_where + ": " + proximity_.chief +
                        " has no state: " + e.what());
    }
  }

  MotionState<Gcrs> in_axes(const FramedState& state, double time_s) const {
    if (is_sgp4()) {
      const auto [r, v] = without_frame(state);
      return {{r.x, r.y, r.z}, {v.x, v.y, v.z}};
    }
    if (const auto* gcrs = std::get_if<MotionState<Gcrs>>(&state)) return *gcrs;
    const SimTime time = sim_seconds(time_s);
    return in_gcrs(state, earth_orientation(clock_, time), time);
  }

  /// Place relative to the chief, in its axes.
  Vec<Rtn> place_at(double time_s) const {
    try {
      return position_m(proximity_.motion, chief_0_, time_s, gm_m3_per_s2_);
    } catch (const Error& e) {
      throw ConfigError(proximity_.where + ": " + e.what());
    }
  }

  void check_orbit() const {
    const auto* model = std::get_if<MotionModel>(&chief_);
    const bool falls = !model || std::holds_alternative<TwoBodyMotion>(*model) ||
                       std::holds_alternative<Trajectory>(*model);
    if (!falls && std::holds_alternative<NaturalMotion>(proximity_.motion))
      throw ConfigError(proximity_.where + ": natural: " + proximity_.chief + " is in no orbit");
    if (!needs_circular_chief(proximity_.motion)) return;
    const double e = eccentricity_of(chief_0_, gm_m3_per_s2_);
    if (!(e <= max_eccentricity))
      throw ConfigError(proximity_.where + ": " +
                        formatted("the eccentricity of %s is %.3g, and Clohessy and Wiltshire's "
                                  "motion is about circles, up to %g: natural with dynamics: "
                                  "two_body takes any",
                                  proximity_.chief.c_str(), e, max_eccentricity));
  }

  void add_segments(const ChiefPath& chief, Trajectory& path) const {
    const StatedMotion motion(chief.model, clock_);
    std::vector<double> ends{chief.span.from_s};
    for (const double corner : corners_s(proximity_.motion))
      if (corner > ends.back() && corner < chief.span.to_s) ends.push_back(corner);
    ends.push_back(chief.span.to_s);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      path.segments.push_back(sampled(motion, {ends[i], ends[i + 1]}));
  }

  /// States at steps of whole nanoseconds, so that the chief's are those of the same instants.
  OemSegment sampled(const StatedMotion& chief, Span span) const {
    constexpr int fewest_steps = 12;
    const double longest_s = std::min(60.0, (span.to_s - span.from_s) / fewest_steps);
    OemSegment segment{.object_name = object_.name,
                       .frame = is_sgp4() ? OemFrame::teme : OemFrame::gcrs,
                       .interpolation = OemInterpolation::lagrange,
                       .degree = 9,
                       .usable_start_s = span.from_s,
                       .usable_stop_s = span.to_s};
    for (double t = span.from_s;;) {
      const MotionState<Gcrs> state = state_of_chief(chief, t);
      const Vec<Gcrs> place_m = state.position_m + gcrs_from_rtn(state, place_at(t));
      segment.time_s.push_back(t);
      segment.position_m.push_back({place_m.x, place_m.y, place_m.z});
      if (t >= span.to_s) return segment;
      const double r_m = norm(state.position_m);
      const double step_s =
          std::min(longest_s, step_rad * std::sqrt(r_m * r_m * r_m / gm_m3_per_s2_));
      const double next_s = sim_seconds(t + step_s).seconds();
      t = span.to_s - t < 1.5 * step_s || !(next_s > t) ? span.to_s : next_s;
    }
  }

  /// Ticks are joined by polynomials, which round a corner off: see `fly_objects`.
  void warn_of_corners() const {
    const auto* approach = std::get_if<ForcedApproach>(&proximity_.motion);
    if (!approach || corners_s(*approach).empty()) return;
    const double off_m = approach->speed_m_per_s * scenario_.tick.seconds() / 4;
    const double distance_m = std::min(norm(approach->from_m), norm(approach->to_m));
    if (off_m > noted_part * distance_m)
      scenario_.warnings.push_back(proximity_.where +
                                   formatted(": approach: about the ticks at which it begins and "
                                             "ends places are up to %.3g m off; a shorter tick_s "
                                             "lessens it",
                                             off_m));
  }

  void warn_of_first_order() const {
    const auto* natural = std::get_if<NaturalMotion>(&proximity_.motion);
    if (!natural || natural->dynamics == RelativeDynamics::two_body) return;
    const NaturalMotion exact{.start = natural->start};
    double off_m = 0.0, part = 0.0;
    for (int i = 1; i <= 20; ++i) {
      const double t = end_s_ * i / 20;
      const Vec<Rtn> there = position_m(exact, chief_0_, t, gm_m3_per_s2_);
      const double error_m = norm(place_at(t) - there);
      off_m = std::max(off_m, error_m);
      part = std::max(part, error_m / std::max(norm(there), 1e-9));
    }
    if (part > noted_part)
      scenario_.warnings.push_back(
          proximity_.where +
          formatted(": natural: Clohessy and Wiltshire's first order is up to %.3g m off two "
                    "bodies in the run",
                    off_m));
  }

  bool is_sgp4() const { return std::holds_alternative<MeanElements>(chief_); }

  Scenario& scenario_;
  OwnObject& object_;
  const ProximityConfig& proximity_;
  Clock clock_;
  double end_s_;
  double gm_m3_per_s2_ = earth_gm_m3_per_s2;
  StatedMotion::Model chief_;
  MotionState<Gcrs> chief_0_;
};

}  // namespace

void place_deputies(Scenario& scenario) {
  for (OwnObject& object : scenario.own_objects)
    if (object.motion.proximity) Deputy(scenario, object).place();
}

}  // namespace dmise
