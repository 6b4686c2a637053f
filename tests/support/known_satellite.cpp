#include "tests/support/known_satellite.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/fusion/catalogue_prediction.h"
#include "core/fusion/kept_orbits.h"
#include "core/orbit/elements/catalogue.h"
#include "core/orbit/elements/epoch.h"
#include "core/orbit/motion.h"
#include "core/orbit/sp3.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

struct Files {
  std::string_view name, orbit, elements;
  double radius_m;
};
// Radii of spheres of albedo 0.3 that are about as bright as the satellites.
constexpr Files known[] = {{"sentinel3a", "sentinel3a.sp3.gz", "Sentinel-3A", 2.0},
                           {"jason1", "jason1.sp3.gz", "Jason-1", 1.5}};

const Files& files_of(const std::string& name) {
  for (const Files& f : known)
    if (f.name == name) return f;
  throw Error("no satellite " + name);
}

std::vector<MeanElements> every_set(const std::string& data, std::string_view name) {
  return read_catalogue(data + "/validation/orbits/" + std::string(name) + ".tle.gz",
                        {.lenient = true, .keep_every_epoch = true})
      .elements;
}

Utc epoch_of(const MeanElements& e) { return {e.epoch_jd1, e.epoch_jd2}; }

double median(std::vector<double> values) {
  const auto middle = values.begin() + long(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Medians of semi-major axes [m] and inclinations [rad] of sets between two ages.
std::optional<std::array<double, 2>> orbit_between(const std::vector<MeanElements>& sets,
                                                   const Utc& time, double from_days,
                                                   double to_days) {
  std::vector<double> axes, inclinations;
  for (const MeanElements& e : sets) {
    const double days = epoch_days_between(time, epoch_of(e));
    if (days < from_days || days > to_days) continue;
    const double n = e.mean_motion_rad_per_min / 60;
    axes.push_back(std::cbrt(earth_gm_m3_per_s2 / (n * n)));
    inclinations.push_back(e.inclination_rad);
  }
  if (axes.size() < 2) return std::nullopt;
  return std::array{median(axes), median(inclinations)};
}

}  // namespace

KnownSatellite::KnownSatellite(const std::string& data, const std::string& name,
                               const std::string& start)
    : clock_(parse_utc(start), std::make_shared<const IersTable>(
                                   IersTable::read_finals2000a(data + "/eop/finals2000A.all.gz"))),
      orbit_(read_sp3(data + "/validation/orbits/" + std::string(files_of(name).orbit))),
      elements_(every_set(data, files_of(name).elements)),
      radius_m_(files_of(name).radius_m) {}

MotionState<Gcrs> KnownSatellite::truth(SimTime time) const {
  return in_gcrs(state_at(orbit_, clock_.tai(time)), earth_orientation(clock_, time), time);
}

MeanElements KnownSatellite::elements(SimTime time, double age_days) const {
  const MeanElements* newest = nullptr;
  for (const MeanElements& e : elements_) {
    const double age = epoch_days_between(epoch_of(e), clock_.utc(time));
    if (age >= age_days && (!newest || epoch_days_between(epoch_of(*newest), epoch_of(e)) > 0))
      newest = &e;
  }
  if (!newest) throw Error("no element set is old enough");
  return *newest;
}

std::vector<LoggedManoeuvre> logged_manoeuvres(const std::string& data, const std::string& name) {
  const std::string path = data + "/validation/orbits/manoeuvres_" + name + ".yaml";
  const auto sets = every_set(data, name);
  std::ifstream file(path);
  if (!file) throw Error(path + ": can't be read");
  std::vector<LoggedManoeuvre> out;
  for (std::string line; std::getline(file, line);) {
    if (line.size() < 21 || line.substr(0, 2) != "- ") continue;
    std::string utc = line.substr(2, 19);
    utc[10] = 'T';
    const Utc time = parse_utc(utc);
    const auto before = orbit_between(sets, time, -3.0, -0.05);
    const auto after = orbit_between(sets, time, 0.3, 3.3);
    if (!before || !after) continue;
    const double speed = std::sqrt(earth_gm_m3_per_s2 / (*before)[0]);
    out.push_back({utc, speed * ((*after)[0] - (*before)[0]) / (2 * (*before)[0]),
                   speed * ((*after)[1] - (*before)[1])});
  }
  return out;
}

OrbitEstimate believed(const MeanElements& elements, const Clock& clock, SimTime time) {
  CataloguePrediction catalogue({elements}, clock, {});
  catalogue.move(time);
  if (!catalogue.known(0)) throw Error("SGP4 has no state");
  return with_usual_scales(catalogue.estimate(0));
}

}  // namespace dmise
