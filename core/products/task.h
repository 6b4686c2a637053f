#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "core/base/units.h"
#include "core/products/product_fields.h"

namespace dmise {

/// What a sensor that is cued is told to observe, and why: it slews from `start`, has settled on
/// the target by `on_target`, and follows the predicted path to `end`. It ends what is left of
/// earlier tasks at `start`.
struct Task {
  std::uint32_t id = 0;  // in the run, from 1
  std::string sensor;
  std::uint32_t track = 0;             // id of the target
  std::uint32_t catalogue_number = 0;  // the target's; 0: in no catalogue
  std::string name;                    // the target's; may be empty
  SimTime given, start, on_target, end;
  std::uint32_t first_frame = 0, exposures = 0;  // that fit between `on_target` and `end`
  // The predicted path, at `path_start` and every `path_step_s` after, at least 2 points: all
  // x, y, z of the first, of the second, ... in GCRS.
  SimTime path_start;
  double path_step_s = 0.0;
  std::vector<double> path_m, path_m_per_s;
  // Lower triangle by rows of the predicted position and velocity at `on_target`, as of a track.
  std::array<double, 21> covariance{};
  double sigma_rad = 0.0;               // predicted direction at `on_target`, the larger axis
  double slew_rad = 0.0, slew_s = 0.0;  // angle and time with settling, from `start`
  double in_field = 0.0;                // probability that the target is in the field, [0, 1]
  double detection_probability = 0.0;   // in one exposure, with the one above in it, [0, 1]
  double gain_nats = 0.0;               // expected information of all exposures
  double gain_nats_per_s = 0.0;         // over the time from `start` to `end`: what was compared
  std::uint32_t candidates = 0;         // tracks that the sensor could have observed
  std::uint32_t runner_up = 0;          // track of the next best; 0: none
  double runner_up_nats_per_s = 0.0;

  bool operator==(const Task&) const = default;
};

template <class V, MaybeConst<Task> T>
void visit_fields(V& v, T& t) {
  v("id", t.id);
  v("sensor", t.sensor);
  v("track", t.track);
  v("catalogue_number", t.catalogue_number);
  v("name", t.name);
  v("given", t.given);
  v("start", t.start);
  v("on_target", t.on_target);
  v("end", t.end);
  v("first_frame", t.first_frame);
  v("exposures", t.exposures);
  v("gain_nats", t.gain_nats);
  v("gain_nats_per_s", t.gain_nats_per_s);
  v("candidates", t.candidates);
  v("runner_up", t.runner_up);
  v("runner_up_nats_per_s", t.runner_up_nats_per_s);
  v("in_field", t.in_field);
  v("detection_probability", t.detection_probability);
  v("sigma_rad", t.sigma_rad, "sigma_arcsec", arcsec);
  v("slew_rad", t.slew_rad, "slew_deg", deg);
  v("slew_s", t.slew_s);
  v("covariance", t.covariance, "covariance_gcrs");
  v("path_start", t.path_start);
  v("path_step_s", t.path_step_s);
  v("path_m", t.path_m, "path_gcrs_m");
  v("path_m_per_s", t.path_m_per_s, "path_gcrs_m_per_s");
}

}  // namespace dmise
