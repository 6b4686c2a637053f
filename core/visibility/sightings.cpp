#include "core/visibility/sightings.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/visibility/camera_motion.h"
#include "core/visibility/orbit_bound.h"
#include "core/visibility/touch.h"

namespace dmise {
namespace {

/// Instants of the whole catalogue lie about this far apart, and bounds on speed hold this long.
constexpr double stride_s = 300.0;
constexpr double bound_holds_s = 3600.0;

/// States of a whole catalogue at one instant.
struct States {
  std::vector<double> position, velocity;
  std::vector<std::uint8_t> code;

  explicit States(std::size_t n) : position(3 * n), velocity(3 * n), code(n) {}
  static Vec<Teme> vec(const std::vector<double>& v, std::size_t i) {
    const std::size_t n = v.size() / 3;
    return {v[i], v[n + i], v[2 * n + i]};
  }
  Vec<Teme> place(std::size_t i) const { return vec(position, i); }
  OrbitBound bound(std::size_t i) const {
    return code[i] ? OrbitBound{} : orbit_bound(place(i), vec(velocity, i));
  }
};

class Search {
 public:
  Search(const Sgp4Batch& batch, const SensorTrack& track, const TimeGrid& grid, Threads& threads,
         const SightingOptions& options)
      : batch_(batch),
        track_(track),
        sight_(track.sensor()),
        grid_(grid),
        step_s_(grid.step.seconds()),
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
    for (std::size_t i = 0; i < batch_.size(); ++i) bound_before_[i] = before_.bound(i);
    for (std::size_t first = 0;; first += part) {
      const std::size_t last = std::min(first + part, grid_.steps);
      search_part(first, last, stride);
      if (options_.progress)
        options_.progress(double(last) / double(std::max<std::size_t>(1, grid_.steps)));
      if (last == grid_.steps) break;
    }
    return sorted();
  }

 private:
  /// What one range of objects found.
  struct Found {
    std::vector<Sighting> seen;
    std::vector<Crossing> crossings;
    std::vector<LostObject> lost;
  };

  void propagate(std::size_t step, States& states) const {
    const Utc utc = track_.sky().clock().utc(grid_.at(step));
    batch_.propagate(utc.jd1, utc.jd2, states.position, states.velocity, states.code, &threads_);
  }

  void search_part(std::size_t first, std::size_t last, std::size_t stride) {
    cameras_.clear();
    lights_.clear();
    first_instant_ = first;
    for (std::size_t k = first; k <= last; ++k) {
      cameras_.push_back(track_.at(grid_.at(k)));
      lights_.emplace_back(track_.sky(), grid_.at(k));
    }
    motion_ = camera_motion(track_, cameras_, step_s_);
    propagate(last, ahead_);
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      const OrbitBound bound_ahead = ahead_.bound(i);
      const OrbitBound b = either(bound_before_[i], bound_ahead);
      bound_before_[i] = bound_ahead;
      reach_[i] =
          motion_.with_earth ? b.turning_speed_m_per_s : b.speed_m_per_s + motion_.speed_m_per_s;
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
  void hide(std::size_t step, const States& states, std::vector<double>& hidden) const {
    const CameraMoment& now = camera(step);
    threads_.for_ranges(batch_.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        hidden[i] = states.code[i] || !now.there ? 0.0 : sight_.hidden_m(now, states.place(i));
    });
  }

  const CameraMoment& camera(std::size_t step) const { return cameras_[step - first_instant_]; }
  const Sunlight& light(std::size_t step) const { return lights_[step - first_instant_]; }

  /// Whether an object this far from being visible at two instants can be so between them.
  bool may_come(std::size_t i, double hidden_a, double hidden_b, double range_m, double s) const {
    if (!(hidden_a > 0.0) || !(hidden_b > 0.0)) return true;
    const double turn = motion_.turn_rad_per_s;
    const double speed = turn > 0.0 ? reach_[i] + turn * (range_m + reach_[i] * s) : reach_[i];
    return !(hidden_a + hidden_b > speed * s);
  }

  void search_stride(std::size_t from, std::size_t to) {
    candidates_.clear();
    const double s = double(to - from) * step_s_;
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      if (track_.platform() == i || (before_.code[i] && after_.code[i] && to > from)) continue;
      const double range_m = motion_.turn_rad_per_s > 0.0 && !before_.code[i]
                                 ? norm(before_.place(i) - camera(from).apex_m)
                                 : 0.0;
      if (before_.code[i] || after_.code[i] ||
          may_come(i, hidden_before_[i], hidden_after_[i], range_m, s))
        candidates_.push_back(std::uint32_t(i));
    }
    constexpr std::size_t grain = 64;
    const std::size_t first = found_.size();
    found_.resize(first + (candidates_.size() + grain - 1) / grain);
    threads_.for_ranges(candidates_.size(), grain, [&](std::size_t begin, std::size_t end) {
      Looker looker{*this, found_[first + begin / grain]};
      for (std::size_t k = begin; k < end; ++k) looker.look(candidates_[k], from, to);
    });
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      const std::uint8_t code = before_.code[i] ? before_.code[i] : after_.code[i];
      if (code && track_.platform() != i)
        lost_.try_emplace(std::uint32_t(i),
                          LostObject{std::uint32_t(i), static_cast<Sgp4Code>(code),
                                     grid_.at(before_.code[i] ? from : to)});
    }
  }

  /// Looks at single objects, with room for their states.
  struct Looker {
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

    /// All instants in [from, to] at which it may be visible, without `from` unless that is 0.
    void look(std::uint32_t object, std::size_t from, std::size_t to) {
      const Search& s = search;
      std::size_t begin = from, end = to;
      if (!s.before_.code[object] && !s.after_.code[object] && !(s.motion_.turn_rad_per_s > 0.0)) {
        // It needs so many steps to come into sight from either end; one more on each side, so that
        // crossings are seen between neighbours.
        const double step_m = s.reach_[object] * s.step_s_;
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
        const Vec<Teme> p = States::vec(position, k);
        hidden[k] = code[k] || !now.there ? 0.0 : s.sight_.hidden_m(now, p);
        visible[k] = !code[k] && !(hidden[k] > 0.0) && s.sight_.visible(now, p);
        if (code[k]) continue;
        const double range = norm(p - now.apex_m);
        range_m = std::max(range_m, range);
        if (visible[k] && (begin + k > from || from == 0))
          found.seen.push_back(
              {object, std::uint32_t(begin + k), range, s.light(begin + k).fraction(p)});
      }
      if (!s.options_.crossings) return;
      for (std::size_t k = 0; k + 1 < count; ++k)
        if (!visible[k] && !visible[k + 1]) {
          const double a = hidden[k], b = hidden[k + 1];
          if (!s.may_come(object, a, b, range_m, s.step_s_)) continue;
          const SimTime t = s.grid_.at(begin + k);
          if (const auto when = crossing(object, t, a, t + s.grid_.step, b, range_m))
            found.crossings.push_back({object, std::uint32_t(begin + k), *when});
        }
    }

    /// An instant strictly between two at which it is visible, if there is one.
    std::optional<SimTime> crossing(std::uint32_t object, SimTime a, double hidden_a, SimTime b,
                                    double hidden_b, double range_m) const {
      const Search& s = search;
      return touch_between(
          a, std::max(hidden_a, 0.0), b, std::max(hidden_b, 0.0), shortest_crossing_s,
          [&](double from_m, double to_m, double seconds) {
            return s.may_come(object, from_m, to_m, range_m, seconds);
          },
          [&](SimTime t) {
            const CameraMoment now = s.track_.at(t);
            const Sgp4State state = s.batch_.propagate_one(
                object, s.batch_.minutes_since_epoch(object, now.utc.jd1, now.utc.jd2));
            if (state.code != Sgp4Code::ok || !now.there) return 0.0;
            if (s.sight_.visible(now, state.position_m)) return -1.0;
            return std::max(0.0, s.sight_.hidden_m(now, state.position_m));
          });
    }
  };

  Sightings sorted() {
    Sightings all;
    // Ranges were filled in order of time: a stable count by object leaves each object's in order.
    std::vector<std::size_t> place(batch_.size() + 1, 0);
    for (const Found& f : found_)
      for (const Sighting& s : f.seen) ++place[s.object + 1];
    for (std::size_t i = 0; i < batch_.size(); ++i) place[i + 1] += place[i];
    all.seen.resize(place.back());
    for (const Found& f : found_)
      for (const Sighting& s : f.seen) all.seen[place[s.object]++] = s;
    for (const Found& f : found_)
      all.crossings.insert(all.crossings.end(), f.crossings.begin(), f.crossings.end());
    std::stable_sort(all.crossings.begin(), all.crossings.end(),
                     [](const Crossing& a, const Crossing& b) { return a.object < b.object; });
    for (const auto& [object, lost] : lost_) all.lost.push_back(lost);
    return all;
  }

  const Sgp4Batch& batch_;
  const SensorTrack& track_;
  const Sight sight_;
  const TimeGrid grid_;
  const double step_s_;
  Threads& threads_;
  const SightingOptions& options_;

  States before_, after_, ahead_;  // at both ends of a stride, and at the end of the part
  std::vector<double> hidden_before_, hidden_after_;
  std::vector<double> reach_;  // farthest that an object can move in the camera's axes [m/s]
  std::vector<OrbitBound> bound_before_;
  std::vector<CameraMoment> cameras_;  // of the part, from step `first_instant_`
  std::vector<Sunlight> lights_;       // the same
  std::size_t first_instant_ = 0;
  CameraMotion motion_;
  std::vector<std::uint32_t> candidates_;
  std::vector<Found> found_;
  std::map<std::uint32_t, LostObject> lost_;
};

}  // namespace

Sightings find_sightings(const Sgp4Batch& batch, const SensorTrack& track, const TimeGrid& grid,
                         Threads& threads, const SightingOptions& options) {
  return Search(batch, track, grid, threads, options).run();
}

Sightings find_sightings_one_by_one(const Sgp4Batch& batch, const SensorTrack& track,
                                    const TimeGrid& grid) {
  const Sight sight(track.sensor());
  Sightings all;
  States states(batch.size());
  for (std::size_t k = 0; k <= grid.steps; ++k) {
    const CameraMoment now = track.at(grid.at(k));
    const Sunlight light(track.sky(), grid.at(k));
    batch.propagate(now.utc.jd1, now.utc.jd2, states.position, states.velocity, states.code);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (states.code[i] || track.platform() == i) continue;
      const Vec<Teme> p = states.place(i);
      if (sight.visible(now, p))
        all.seen.push_back(
            {std::uint32_t(i), std::uint32_t(k), norm(p - now.apex_m), light.fraction(p)});
    }
  }
  std::stable_sort(all.seen.begin(), all.seen.end(),
                   [](const Sighting& a, const Sighting& b) { return a.object < b.object; });
  return all;
}

}  // namespace dmise
