#include "sensors/survey/shells.h"

#include <algorithm>

#include "core/base/formatted.h"
#include "core/orbit/sgp4/catalogue_report.h"
#include "core/orbit/sgp4/sgp4_terms.h"

namespace dmise {
namespace {}  // namespace

double mean_altitude_km(const MeanElements& elements) {
  return semi_major_axis_km(elements) - sgp4::earth_radius_km;
}

Shells shells_of(const ObjectPopulation& population, const std::vector<double>& limits_km) {
  Shells out;
  const auto add = [&](std::string name) { out.shells.push_back({std::move(name), 0}); };
  if (limits_km.empty()) {
    add("LEO");
  } else {
    add(formatted("below %g km", limits_km.front()));
    for (std::size_t k = 1; k < limits_km.size(); ++k)
      add(formatted("%g-%g km", limits_km[k - 1], limits_km[k]));
    add(formatted("LEO above %g km", limits_km.back()));
  }
  const std::size_t low = out.shells.size();
  for (const char* name : {"MEO", "GEO", "HEO", "beyond GEO", "own motion"}) add(name);
  for (std::size_t i = 0; i < population.roster.objects.size(); ++i) {
    std::size_t shell = low + 4;
    if (i < population.elements.size()) {
      const MeanElements& e = population.elements[i];
      switch (regime_of(e)) {
        case OrbitRegime::low:
          shell = std::size_t(
              std::upper_bound(limits_km.begin(), limits_km.end(), mean_altitude_km(e)) -
              limits_km.begin());
          break;
        case OrbitRegime::medium:
          shell = low;
          break;
        case OrbitRegime::geosynchronous:
          shell = low + 1;
          break;
        case OrbitRegime::highly_elliptic:
          shell = low + 2;
          break;
        case OrbitRegime::beyond:
          shell = low + 3;
          break;
      }
    }
    out.of_object.push_back(std::uint8_t(shell));
    ++out.shells[shell].objects;
  }
  return out;
}

}  // namespace dmise
