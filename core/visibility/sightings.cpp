#include "core/visibility/sightings.h"

#include <algorithm>
#include <limits>
#include <map>

#include "core/frames/rotation_angle.h"
#include "core/visibility/batch_states.h"
#include "core/visibility/crossing.h"
#include "core/visibility/orbit_bound.h"
#include "core/visibility/sensor_track.h"

namespace dmise {
namespace {

/// Linear and angular speed of a camera over some time, in the axes in which objects are bounded.
struct CameraMotion {
  double speed_m_per_s = 0.0;   // in TEME
  double turn_rad_per_s = 0.0;  // its own axes turn in TEME
};

constexpr double motion_margin = 1.25;

/// Bound from the camera at two instants some seconds apart, plus a quarter. Zero for a camera
/// fixed to the Earth, in axes that rotate with it; zero turn for one fixed relative to the stars;
/// infinite if the camera exists at only one of the instants, 0 if at none.
CameraMotion camera_motion(const SensorTrack& track, const CameraMoment& a, const CameraMoment& b) {
  if (track.fixed_to_earth() || (!a.there && !b.there)) return {};
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (!a.there || !b.there) return {.speed_m_per_s = infinite, .turn_rad_per_s = infinite};
  const double share = motion_margin / (b.time - a.time).seconds();
  CameraMotion motion{.speed_m_per_s = share * norm(b.apex_m - a.apex_m)};
  if (!track.fixed_to_stars())
    motion.turn_rad_per_s =
        share * rotation_angle_rad(a.camera_from_teme * b.camera_from_teme.inverse());
  return motion;
}

/// The maximum of each.
CameraMotion either(const CameraMotion& a, const CameraMotion& b) {
  return {std::max(a.speed_m_per_s, b.speed_m_per_s), std::max(a.turn_rad_per_s, b.turn_rad_per_s)};
}

/// Maximum distance of neighbouring instants, from which a camera's motion is bounded.
constexpr double longest_look_s = 10.0;
/// Approximate distance of instants for the whole catalogue; bounds on speed hold this long.
constexpr double stride_s = 300.0;
constexpr double bound_holds_s = 3600.0;

OrbitBound bound_of(const BatchStates& states, std::size_t i) {
  return states.code[i] ? OrbitBound{} : orbit_bound(states.place_m(i), states.speed_m_per_s(i));
}

/// An object that is visible at all instants from `first` to `last` of a grid.
struct SeenRun {
  std::uint32_t object = 0;
  std::size_t first = 0, last = 0;
};

/// Intervals by object, then time: consecutive runs are merged, and each crossing [between two
/// instants that are in no run] is an interval. Input in any order.
std::vector<VisibilityInterval> intervals_of(std::vector<SeenRun> runs,
                                             std::vector<VisibilityInterval> crossings,
                                             const FineGrid& grid) {
  std::sort(runs.begin(), runs.end(), [](const SeenRun& a, const SeenRun& b) {
    return a.object != b.object ? a.object < b.object : a.first < b.first;
  });
  std::vector<VisibilityInterval> all = std::move(crossings);
  for (std::size_t k = 0; k < runs.size();) {
    SeenRun run = runs[k++];
    while (k < runs.size() && runs[k].object == run.object && runs[k].first == run.last + 1)
      run.last = runs[k++].last;
    const bool from_start = run.first == 0, to_end = run.last == grid.steps();
    all.push_back({run.object, grid.at(from_start ? run.first : run.first - 1), grid.at(run.first),
                   grid.at(run.last), grid.at(to_end ? run.last : run.last + 1), from_start,
                   to_end});
  }
  std::sort(all.begin(), all.end(), [](const VisibilityInterval& a, const VisibilityInterval& b) {
    return a.object != b.object ? a.object < b.object : a.in_first < b.in_first;
  });
  return all;
}

class Search {
 public:
  Search(const Sgp4Batch& batch, const SensorTrack& track, const TimeGrid& grid, Threads& threads,
         const SightingOptions& options)
      : batch_(batch),
        track_(track),
        sight_(track.sensor()),
        grid_(grid, sim_seconds(longest_look_s)),
        step_s_(grid_.step_s()),
        threads_(threads),
        options_(options),
        before_(batch.size()),
        after_(batch.size()),
        ahead_(batch.size()),
        hidden_before_(batch.size()),
        hidden_after_(batch.size()),
        reach_(batch.size()),
        bound_before_(batch.size()) {}

  Sightings run() {
    const std::size_t stride = std::max<std::size_t>(1, std::size_t(stride_s / step_s_));
    const std::size_t part =
        stride * std::max<std::size_t>(1, std::size_t(bound_holds_s / (step_s_ * double(stride))));
    propagate(0, before_);
    for (std::size_t i = 0; i < batch_.size(); ++i) bound_before_[i] = bound_of(before_, i);
    for (std::size_t first = 0;; first += part) {
      const std::size_t last = std::min(first + part, grid_.steps());
      search_part(first, last, stride);
      if (options_.progress)
        options_.progress(double(last) / double(std::max<std::size_t>(1, grid_.steps())));
      if (last == grid_.steps()) break;
    }
    return sorted();
  }

 private:
  /// Results of one range of objects.
  struct Found {
    std::vector<Sighting> seen;
    std::vector<SeenRun> runs;
    std::vector<VisibilityInterval> crossings;
  };

  void propagate(std::size_t step, BatchStates& states) const {
    const Utc utc = track_.sky().clock().utc(grid_.at(step));
    batch_.propagate(utc.jd1, utc.jd2, states.position_m, states.velocity_m_per_s, states.code,
                     &threads_);
  }

  void search_part(std::size_t first, std::size_t last, std::size_t stride) {
    cameras_.clear();
    lights_.clear();
    first_instant_ = first;
    for (std::size_t k = first; k <= last; ++k) {
      cameras_.push_back(track_.at(grid_.at(k)));
      lights_.emplace_back(track_.sky(), grid_.at(k));
    }
    motions_.clear();
    for (std::size_t k = 0; k + 1 < cameras_.size(); ++k)
      motions_.push_back(camera_motion(track_, cameras_[k], cameras_[k + 1]));
    propagate(last, ahead_);
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      const OrbitBound bound_ahead = bound_of(ahead_, i);
      const OrbitBound b = either(bound_before_[i], bound_ahead);
      bound_before_[i] = bound_ahead;
      reach_[i] = track_.fixed_to_earth() ? b.turning_speed_m_per_s : b.speed_m_per_s;
    }
    hide(first, before_, hidden_before_);
    std::size_t from = first;
    do {
      const std::size_t to = std::min(from + stride, last);
      if (to == last)
        std::swap(after_, ahead_);
      else
        propagate(to, after_);
      hide(to, after_, hidden_after_);
      search_stride(from, to);
      std::swap(before_, after_);
      std::swap(hidden_before_, hidden_after_);
      from = to;
    } while (from < last);
  }

  /// Distances of all objects from being visible at one instant.
  void hide(std::size_t step, const BatchStates& states, std::vector<double>& hidden) const {
    const CameraMoment& now = camera(step);
    threads_.for_ranges(batch_.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        hidden[i] = states.code[i] || !now.there ? 0.0 : sight_.hidden_m(now, states.place_m(i));
    });
  }

  const CameraMoment& camera(std::size_t step) const { return cameras_[step - first_instant_]; }
  /// Motion of the camera from one instant to the next.
  const CameraMotion& motion(std::size_t step) const { return motions_[step - first_instant_]; }
  const Sunlight& light(std::size_t step) const { return lights_[step - first_instant_]; }

  /// Whether an object at these distances from being visible at two instants may be visible between
  /// them, given the camera's motion.
  bool may_come(std::size_t i, double hidden_a, double hidden_b, double range_m, double s,
                const CameraMotion& motion) const {
    if (!(hidden_a > 0.0) || !(hidden_b > 0.0)) return true;
    const double speed = reach_[i] + motion.speed_m_per_s;
    const double turning =
        motion.turn_rad_per_s > 0.0 ? motion.turn_rad_per_s * (range_m + speed * s) : 0.0;
    return !(hidden_a + hidden_b > (speed + turning) * s);
  }

  void search_stride(std::size_t from, std::size_t to) {
    candidates_.clear();
    motion_ = {};
    for (std::size_t k = from; k < to; ++k) motion_ = either(motion_, motion(k));
    const double s = double(to - from) * step_s_;
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      if (track_.platform() == i || (before_.code[i] && after_.code[i] && to > from)) continue;
      const double range_m = motion_.turn_rad_per_s > 0.0 && !before_.code[i]
                                 ? norm(before_.place_m(i) - camera(from).apex_m)
                                 : 0.0;
      if (before_.code[i] || after_.code[i] ||
          may_come(i, hidden_before_[i], hidden_after_[i], range_m, s, motion_))
        candidates_.push_back(std::uint32_t(i));
    }
    constexpr std::size_t grain = 64;
    const std::size_t first = found_.size();
    found_.resize(first + (candidates_.size() + grain - 1) / grain);
    threads_.for_ranges(candidates_.size(), grain, [&](std::size_t begin, std::size_t end) {
      Examiner examiner{*this, found_[first + begin / grain]};
      for (std::size_t k = begin; k < end; ++k) examiner.examine(candidates_[k], from, to);
    });
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      const std::uint8_t code = before_.code[i] ? before_.code[i] : after_.code[i];
      if (code && track_.platform() != i)
        lost_.try_emplace(std::uint32_t(i),
                          LostObject{std::uint32_t(i), static_cast<Sgp4Code>(code),
                                     grid_.at(before_.code[i] ? from : to)});
    }
  }

  /// Examines single objects, with buffers for their states.
  struct Examiner {
    const Search& search;
    Found& found;
    std::vector<double> minutes, position, velocity, hidden;
    std::vector<std::uint8_t> code, visible;

    void propagate(std::uint32_t object, std::size_t count) {
      position.resize(3 * count);
      velocity.resize(3 * count);
      code.resize(count);
      search.batch_.propagate_times(object, {minutes.data(), count}, position, velocity, code);
    }

    /// Finds all instants in [from, to] at which it may be visible; `from` only if it is 0.
    void examine(std::uint32_t object, std::size_t from, std::size_t to) {
      const Search& s = search;
      std::size_t begin = from, end = to;
      if (!s.before_.code[object] && !s.after_.code[object] && !(s.motion_.turn_rad_per_s > 0.0)) {
        // It needs this many steps to become visible from either end; one more on each side, so
        // that crossings are found between neighbours.
        const double step_m = (s.reach_[object] + s.motion_.speed_m_per_s) * s.step_s_;
        begin += std::size_t(std::clamp(s.hidden_before_[object] / step_m, 0.0, double(to - from)));
        end -= std::size_t(std::clamp(s.hidden_after_[object] / step_m, 0.0, double(to - from)));
        if (begin > end) std::swap(begin, end);
      }
      const std::size_t count = end - begin + 1;
      minutes.resize(count);
      for (std::size_t k = 0; k < count; ++k) {
        const Utc& utc = s.camera(begin + k).utc;
        minutes[k] = s.batch_.minutes_since_epoch(object, utc.jd1, utc.jd2);
      }
      propagate(object, count);
      hidden.resize(count);
      visible.resize(count);
      double range_m = 0.0;
      for (std::size_t k = 0; k < count; ++k) {
        const CameraMoment& now = s.camera(begin + k);
        const Vec<Teme> p = BatchStates::vec(position, k);
        hidden[k] = code[k] || !now.there ? 0.0 : s.sight_.hidden_m(now, p);
        visible[k] = !code[k] && !(hidden[k] > 0.0) && s.sight_.visible(now, p);
        if (code[k]) continue;
        const double range = norm(p - now.apex_m);
        range_m = std::max(range_m, range);
        if (visible[k] && (begin + k > from || from == 0))
          note(object, begin + k, range, [&] { return s.light(begin + k).fraction(p); });
      }
      if (!s.options_.intervals) return;
      for (std::size_t k = 0; k + 1 < count; ++k) {
        const bool none = code[k] && code[k + 1];
        const bool there = s.camera(begin + k).there || s.camera(begin + k + 1).there;
        if (!visible[k] && !visible[k + 1] && !none && there)
          examine_between(object, begin + k, hidden[k], hidden[k + 1], range_m);
      }
    }

    /// Records that it is visible at this instant.
    template <class Sunlit>
    void note(std::uint32_t object, std::size_t step, double range_m, Sunlit&& sunlit) {
      if (const auto of_grid = search.grid_.of_grid(step))
        found.seen.push_back({object, *of_grid, range_m, sunlit()});
      if (!search.options_.intervals) return;
      auto& runs = found.runs;
      if (!runs.empty() && runs.back().object == object && runs.back().last + 1 == step)
        ++runs.back().last;
      else
        runs.push_back({object, step, step});
    }

    /// Searches for an instant strictly between two neighbours at which it is visible.
    void examine_between(std::uint32_t object, std::size_t step, double hidden_a_m,
                         double hidden_b_m, double range_m) {
      const Search& s = search;
      const SimTime a = s.grid_.at(step), b = s.grid_.at(step + 1);
      const auto when = crossing_between(
          a, std::max(hidden_a_m, 0.0), b, std::max(hidden_b_m, 0.0), shortest_crossing_s,
          [&](double from_m, double to_m, double seconds) {
            return s.may_come(object, from_m, to_m, range_m, seconds, s.motion(step));
          },
          [&](SimTime t) {
            const CameraMoment now = s.track_.at(t);
            const Sgp4State state = s.batch_.propagate_one(
                object, s.batch_.minutes_since_epoch(object, now.utc.jd1, now.utc.jd2));
            if (state.code != Sgp4Code::ok || !now.there) return 0.0;
            if (s.sight_.visible(now, state.position_m)) return -1.0;
            return std::max(0.0, s.sight_.hidden_m(now, state.position_m));
          });
      if (when) found.crossings.push_back({object, a, *when, *when, b});
    }
  };

  Sightings sorted() {
    Sightings all;
    // Ranges were filled in order of time: a stable counting sort by object keeps that order.
    std::vector<std::size_t> place(batch_.size() + 1, 0);
    for (const Found& f : found_)
      for (const Sighting& s : f.seen) ++place[s.object + 1];
    for (std::size_t i = 0; i < batch_.size(); ++i) place[i + 1] += place[i];
    all.seen.resize(place.back());
    for (const Found& f : found_)
      for (const Sighting& s : f.seen) all.seen[place[s.object]++] = s;
    std::vector<SeenRun> runs;
    std::vector<VisibilityInterval> crossings;
    for (const Found& f : found_) {
      runs.insert(runs.end(), f.runs.begin(), f.runs.end());
      crossings.insert(crossings.end(), f.crossings.begin(), f.crossings.end());
    }
    all.intervals = intervals_of(std::move(runs), std::move(crossings), grid_);
    for (const auto& [object, lost] : lost_) all.lost.push_back(lost);
    return all;
  }

  const Sgp4Batch& batch_;
  const SensorTrack& track_;
  const Sight sight_;
  const FineGrid grid_;
  const double step_s_;
  Threads& threads_;
  const SightingOptions& options_;

  BatchStates before_, after_, ahead_;  // at both ends of a stride, and at the end of the part
  std::vector<double> hidden_before_, hidden_after_;
  std::vector<double> reach_;  // bounds on the objects' speeds in the axes of the bounds [m/s]
  std::vector<OrbitBound> bound_before_;
  std::vector<CameraMoment> cameras_;  // over the part, from step `first_instant_`
  std::vector<Sunlight> lights_;       // at those instants
  std::size_t first_instant_ = 0;
  std::vector<CameraMotion> motions_;  // between the instants of the part
  CameraMotion motion_;                // maximum of the stride
  std::vector<std::uint32_t> candidates_;
  std::vector<Found> found_;
  std::map<std::uint32_t, LostObject> lost_;
};

}  // namespace

Sightings find_sightings(const Sgp4Batch& batch, const SensorTrack& track, const TimeGrid& grid,
                         Threads& threads, const SightingOptions& options) {
  return Search(batch, track, grid, threads, options).run();
}

}  // namespace dmise
