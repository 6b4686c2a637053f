#include "tests/support/sightings_one_by_one.h"

#include <algorithm>

#include "core/visibility/batch_states.h"

namespace dmise {

Sightings find_sightings_one_by_one(const Sgp4Batch& batch, const SensorTrack& track,
                                    const TimeGrid& grid) {
  const Sight sight(track.sensor());
  Sightings all;
  BatchStates states(batch.size());
  for (std::size_t k = 0; k <= grid.steps; ++k) {
    const CameraMoment now = track.at(grid.at(k));
    const Sunlight light(track.sky(), grid.at(k));
    batch.propagate(now.utc.jd1, now.utc.jd2, states.position_m, states.velocity_m_per_s,
                    states.code);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (states.code[i] || track.platform() == i) continue;
      const Vec<Teme> p = states.place_m(i);
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
