#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "clients/engine/arrays.h"
#include "clients/engine/engine.h"
#include "clients/engine/interruptible.h"
#include "core/base/formatted.h"
#include "core/orbit/elements/catalogue.h"
#include "core/propagation/catalogue_states.h"
#include "core/time/iso8601.h"

namespace nb = nanobind;

namespace dmise {
namespace {

struct Catalogue {
  CatalogueFile file;
};

std::vector<std::string> described(const CatalogueFile& file,
                                   const std::vector<CatalogueProblem>& problems) {
  std::vector<std::string> lines;
  for (const auto& problem : problems) lines.push_back(file.describe(problem));
  return lines;
}

Catalogue with_elements(CatalogueFile file) {
  if (file.elements.empty())
    throw ConfigError(file.refused.empty() ? file.source + ": contains no element sets"
                                           : file.describe(file.refused[0]));
  return {std::move(file)};
}

StateAxes axes_named(const std::string& name) {
  if (name == "teme") return StateAxes::teme;
  if (name == "gcrs") return StateAxes::gcrs;
  if (name == "itrs") return StateAxes::itrs;
  throw ConfigError("axes: must be teme, gcrs or itrs, got " + name);
}

/// States at times of ISO 8601, in UTC.
CatalogueStates states_at(const std::vector<MeanElements>& elements,
                          const std::vector<std::string>& times, StateAxes axes,
                          const std::string& earth_orientation, int thread_count) {
  std::vector<Utc> utc;
  for (const std::string& time : times) utc.push_back(parse_utc(time));
  const auto iers =
      earth_orientation.empty()
          ? nullptr
          : std::make_shared<const IersTable>(IersTable::read_finals2000a(earth_orientation));
  Threads threads(thread_count);
  return states_of(elements, utc, axes, iers, threads);
}

}  // namespace

void add_catalogues(nb::module_& module) {
  nb::class_<Catalogue>(module, "Catalogue")
      .def_static("of_file",
                  [](const std::string& path) { return with_elements(read_catalogue(path)); })
      .def_static("of_text",
                  [](const std::string& text, const std::string& name) {
                    return with_elements(parse_catalogue(text, name));
                  })
      .def_prop_ro("refused", [](const Catalogue& c) { return described(c.file, c.file.refused); })
      .def_prop_ro("warnings",
                   [](const Catalogue& c) { return described(c.file, c.file.warnings); })
      .def_prop_ro("numbers",
                   [](const Catalogue& c) {
                     std::vector<std::uint32_t> numbers;
                     for (const auto& e : c.file.elements) numbers.push_back(e.catalogue_number);
                     return numbers;
                   })
      .def_prop_ro("names",
                   [](const Catalogue& c) {
                     std::vector<std::string> names;
                     for (const auto& e : c.file.elements) names.push_back(e.name);
                     return names;
                   })
      .def("states", [](const Catalogue& catalogue, std::vector<std::string> times,
                        const std::string& axes, std::string earth_orientation, int threads) {
        CatalogueStates states = interruptible<CatalogueStates>(
            [elements = catalogue.file.elements, times = std::move(times), axes = axes_named(axes),
             earth_orientation = std::move(earth_orientation), threads = checked_threads(threads)] {
              return states_at(elements, times, axes, earth_orientation, threads);
            });
        const std::size_t n = states.objects, m = states.times;
        return nb::make_tuple(array_of(std::move(states.position_m), {n, m, 3}),
                              array_of(std::move(states.velocity_m_per_s), {n, m, 3}),
                              array_of(std::move(states.code), {n, m}));
      });
}

}  // namespace dmise
