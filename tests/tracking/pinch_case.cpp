// Looks for the point from which objects came, for tests/reference/breakups_with_scipy.py.
//
// Standard input: START_UTC, then for each breakup COUNT and COUNT lines of `TIME_S X Y Z VX VY VZ
// SIGMA_M SIGMA_M_PER_S`: states in GCRS [m, m/s]. Standard output: a line of JSON for each.
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/time/iso8601.h"
#include "core/tracking/maintenance/pinch_search.h"

namespace dmise {
namespace {

constexpr double day_s = 86400.0;
constexpr int gravity_degree = 4;  // as the paths have it

OrbitEstimate read_estimate(std::istream& in) {
  double time_s = 0, sigma_m = 0, sigma_m_per_s = 0;
  OrbitEstimate out;
  auto& r = out.state.position_m;
  auto& v = out.state.velocity_m_per_s;
  if (!(in >> time_s >> r.x >> r.y >> r.z >> v.x >> v.y >> v.z >> sigma_m >> sigma_m_per_s))
    throw Error("an object is cut off");
  out.state.time = sim_seconds(time_s);
  out.covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
  out.covariance.diagonal().segment<3>(3).setConstant(sigma_m_per_s * sigma_m_per_s);
  return out;
}

std::string point_of(const MaintenanceForces& forces, std::size_t count) {
  PinchSearch search(forces, sim_seconds(-day_s));
  for (std::size_t k = 0; k < count; ++k) search.put(k, read_estimate(std::cin));
  JsonWriter json;
  json.begin_object();
  if (const auto point = search.of(count - 1)) {
    json.field("time_s", point->time.seconds()).field("time_sigma_s", point->time_sigma_s);
    json.field("members", double(point->members.size())).field("confidence", point->confidence);
    json.field("chi_square", point->chi_square).field("degrees", double(point->degrees));
    const auto& r = point->position_m;
    json.key("position_m").begin_array().value(r.x).value(r.y).value(r.z).end_array();
    json.key("covariance").begin_array();
    for (int i = 0; i < 9; ++i) json.value(point->covariance(i / 3, i % 3));
    json.end_array();
  }
  return json.end_object().take();
}

int run() {
  std::string start;
  std::cin >> start;
  const Clock clock(parse_utc(start));
  MaintenanceSettings settings;
  settings.gravity_degree = gravity_degree;
  const MaintenanceForces forces(clock, sim_seconds(-day_s), sim_seconds(2 * day_s), settings);
  for (std::size_t count = 0; std::cin >> count;) {
    if (count == 0) throw Error("a breakup has no objects");
    std::puts(point_of(forces, count).c_str());
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace dmise

int main() try { return dmise::run(); } catch (const std::exception& error) {
  std::fprintf(stderr, "pinch-case: %s\n", error.what());
  return 1;
}
