#include "core/propagation/catalogue_states.h"

#include "core/frames/earth_orientation.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/time/clock.h"

namespace dmise {
namespace {

/// Writes a state in some axes as the row `at` of `states`.
template <class F>
void set_row(CatalogueStates& states, std::size_t at, const Vec<F>& r, const Vec<F>& v) {
  std::size_t i = 3 * at;
  for (const double x : {r.x, r.y, r.z}) states.position_m[i++] = x;
  i = 3 * at;
  for (const double x : {v.x, v.y, v.z}) states.velocity_m_per_s[i++] = x;
}

/// Writes states in the axes asked for, of one time.
class AxesAt {
 public:
  AxesAt(StateAxes axes, const Utc& utc, const std::shared_ptr<const IersTable>& iers)
      : axes_(axes) {
    if (axes == StateAxes::teme) return;  // needs no Earth
    earth_ = earth_orientation(Clock(utc, iers), {0});
    gcrs_from_teme_ = earth_.gcrs_from_teme({0});
    itrs_from_teme_ = earth_.itrs_from_teme({0});
    itrs_from_gcrs_ = earth_.itrs_from_gcrs({0});
  }

  void write(CatalogueStates& states, std::size_t at, const Vec<Teme>& r,
             const Vec<Teme>& v) const {
    if (axes_ == StateAxes::teme) return set_row(states, at, r, v);
    if (axes_ == StateAxes::gcrs)
      return set_row(states, at, gcrs_from_teme_ * r, gcrs_from_teme_ * v);
    // Velocity relative to the rotating Earth: subtract that of a fixed point.
    const Vec<Itrs> place = itrs_from_teme_ * r;
    set_row(states, at, place,
            itrs_from_teme_ * v - itrs_from_gcrs_ * earth_.velocity_of_fixed_point(place, {0}));
  }

 private:
  StateAxes axes_;
  EarthOrientation earth_;
  Rotation<Gcrs, Teme> gcrs_from_teme_;
  Rotation<Itrs, Teme> itrs_from_teme_;
  Rotation<Itrs, Gcrs> itrs_from_gcrs_;
};

}  // namespace

CatalogueStates states_of(std::span<const MeanElements> elements, std::span<const Utc> times,
                          StateAxes axes, const std::shared_ptr<const IersTable>& iers,
                          Threads& threads) {
  const std::size_t n = elements.size(), all = n * times.size();
  CatalogueStates states{.objects = n,
                         .times = times.size(),
                         .position_m = std::vector<double>(3 * all),
                         .velocity_m_per_s = std::vector<double>(3 * all),
                         .code = std::vector<std::uint8_t>(all)};
  const Sgp4Batch batch(elements, &threads);
  threads.for_ranges(times.size(), 1, [&](std::size_t first, std::size_t last) {
    std::vector<double> position(3 * n), velocity(3 * n);
    std::vector<std::uint8_t> code(n);
    for (std::size_t k = first; k < last; ++k) {
      const AxesAt axes_at(axes, times[k], iers);
      batch.propagate(times[k].jd1, times[k].jd2, position, velocity, code);
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t at = states.index(i, k);
        states.code[at] = code[i];
        if (code[i] != 0) continue;
        axes_at.write(states, at, {position[i], position[n + i], position[2 * n + i]},
                      {velocity[i], velocity[n + i], velocity[2 * n + i]});
      }
    }
  });
  return states;
}

}  // namespace dmise
