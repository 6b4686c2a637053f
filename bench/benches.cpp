#include "bench/benches.h"

#include "bench/bench_all_sky.h"
#include "bench/bench_calibrate.h"
#include "bench/bench_catalogue.h"
#include "bench/bench_cue.h"
#include "bench/bench_detect.h"
#include "bench/bench_effects.h"
#include "bench/bench_figure5.h"
#include "bench/bench_frame.h"
#include "bench/bench_fusion.h"
#include "bench/bench_fusion_tick.h"
#include "bench/bench_interpolation.h"
#include "bench/bench_motion.h"
#include "bench/bench_network.h"
#include "bench/bench_nodes.h"
#include "bench/bench_render.h"
#include "bench/bench_sgp4.h"
#include "bench/bench_sky.h"
#include "bench/bench_stars.h"
#include "bench/bench_survey.h"
#include "bench/bench_tick.h"

namespace dmise {

std::vector<Bench> benches() {
  return {
      {"all-sky", "the paper's all-sky frame, its stages and memory (part of frame)",
       [](bool json) {
         measure_all_sky(json);
         return 0;
       }},
      {"calibrate", "measures what effects cost here, for predicted seconds", bench_calibrate,
       add_calibrate_options},
      {"catalogue", "orbits kept over days against precise ones, manoeuvres found",
       bench_catalogue},
      {"detect", "detection against the ideal matched filter, its time and memory", bench_detect,
       add_detect_options},
      {"effects", "errors and times of planned frames over scenes drawn at random", bench_effects,
       add_effects_options},
      {"frame", "stages of a frame on one thread", bench_frame},
      {"fusion", "orbits from directions: triangulation, filter, least squares; many sensors",
       [](bool json) { return bench_fusion(json) | bench_cue(json) | bench_fusion_tick(json); }},
      {"interpolation", "error and cost of interpolating between ticks", bench_interpolation},
      {"motion", "objects that fly by numerical integration: against Orekit, precise orbits, time",
       bench_motion},
      {"network", "number of sensor processes that keep up with real time, and their memory",
       bench_network, add_network_options},
      {"nodes", "ticks of runs with actors in Python", bench_nodes},
      {"render", "pictures and light of objects with a shape", bench_render},
      {"sgp4", "propagation of whole catalogues against the compiled reference",
       [](bool json) { return bench_sgp4(json) | bench_figure5(json); }},
      {"sky", "the sky of a frame and the stars of a field", bench_sky},
      {"stars", "a field of an index of many stars, and of synthetic ones", bench_stars,
       add_stars_options},
      {"survey", "a night's survey of many sites, and its detections against rendered frames",
       bench_survey, add_survey_options},
      {"tick", "lock-step ticks compared to a bare ZeroMQ floor", bench_tick},
  };
}

}  // namespace dmise
