#include "core/config/objects/generators/population_config.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/search_path.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/orbit/elements/catalogue.h"

namespace dmise {
namespace {

constexpr double first_year = 1988.0, last_year = 2100.0;
constexpr double lowest_m = 200e3, highest_m = 2000e3;  // where the model holds

double year_of(const Utc& time) { return 2000.0 + (time.jd1 - 2451544.5 + time.jd2) / 365.25; }

void read_inclinations(YamlMap& map, const YamlValue& value, DebrisPopulation& population) {
  const auto key = map.find("inclinations");
  const std::string name = key ? key->text() : default_object_catalogue;
  const char* file = object_catalogue_file(name);
  const std::string path = file ? find_catalogue(file) : key->existing_file();
  const YamlValue& place = key ? *key : value;
  if (path.empty()) place.fail(missing_catalogue(file), false);
  try {
    population.inclinations = inclinations_of(read_catalogue(path).elements,
                                              population.min_height_m, population.max_height_m);
  } catch (const Error& e) {
    place.fail(e.what(), false);
  }
  if (std::ranges::max(population.inclinations) == 0)
    place.fail("no object of " + name + " is at these heights", false);
}

}  // namespace

const Section& population_section() {
  using Population = DebrisPopulation;
  static const Section section{
      "population",
      "Debris in low orbits, as many as NASA's engineering model has (Kessler et al. 1989, SSP "
      "30425).",
      {required("min_size_m", form::number(1e-3, 10.0), "Diameter of the smallest objects [m]."),
       bound<&Population::max_size_m>("max_size_m", form::above(1e-3, 10.0),
                                      "Diameter of the largest objects [m]: a catalogue has those "
                                      "beyond."),
       bound<&Population::min_height_m>("min_height_m", form::number(lowest_m, highest_m),
                                        "Least semi-major axis less 6378137 m [m]."),
       bound<&Population::max_height_m>("max_height_m", form::number(lowest_m, highest_m),
                                        "Greatest semi-major axis less 6378137 m [m]."),
       optional("inclinations", form::text({default_object_catalogue}),
                "`demo`, or a file of element sets, of which the objects at these heights give the "
                "distribution of inclinations.",
                default_object_catalogue),
       optional("year", form::number(first_year, last_year),
                "Year of the flux, with its fraction: the model has growth from 1988 on.",
                "that of the start of the run"),
       bound<&Population::solar_flux_sfu>("solar_flux_sfu", form::number(50.0, 400.0),
                                          "The Sun's flux at 10.7 cm, over the year before "
                                          "[10^-22 W/m^2/Hz]: 70 at its minimum, 200 at its "
                                          "maximum. Drag removes low objects where it is high."),
       bound<&Population::scale>("scale", form::above(0.0, 1000.0), "Factor of the number."),
       optional("seed", form::seed(), "Seed of the objects.", "that of the scenario")}};
  return section;
}

DebrisPopulation read_population(const YamlValue& value, const Utc& start) {
  YamlMap map(value, population_section());
  DebrisPopulation population;
  population.epoch = start;
  read_bound(map, population);
  const auto least = map.require("min_size_m");
  population.min_size_m = least.number();
  if (!(population.min_size_m < population.max_size_m))
    least.fail("must be below max_size_m, " + shortest_text(population.max_size_m));
  if (!(population.min_height_m < population.max_height_m))
    value.fail("min_height_m must be below max_height_m", false);
  const auto year = map.find("year");
  population.year = year ? year->number() : year_of(start);
  if (population.year < first_year || population.year > last_year)
    value.fail("needs a year from 1988 to 2100: the run starts in another", false);
  if (const auto seed = map.find("seed")) population.seed = std::uint64_t(seed->integer());
  read_inclinations(map, value, population);
  const double count = population.mean_count();
  if (!(count <= max_debris_objects))
    least.fail("makes " + formatted("%.4g", count) + " objects, at most " +
               std::to_string(max_debris_objects) + " are possible");
  map.done();
  return population;
}

}  // namespace dmise
