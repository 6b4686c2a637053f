#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/orbit/elements/facts_import.h"
#include "core/orbit/elements/object_facts.h"
#include "core/orbit/elements/omm.h"
#include "tests/fuzz/catalogue_invariants.h"

using namespace dmise;

// All notations, through the detection of the format and each by itself; and the CSV of facts.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const auto& read : {read_omm_json, read_omm_csv, read_omm_xml, read_omm_kvn}) {
    CatalogueFile file;
    file.source = "fuzz";
    try {
      read(text, file);
    } catch (const ConfigError&) {
    }
    fuzz::require_sound(file);
  }
  try {
    fuzz::require_sound(parse_catalogue(text, "fuzz"));
  } catch (const ConfigError&) {
  }
  try {
    for (const auto& [number, facts] : parse_object_facts(text, "fuzz").facts) {
      const DiffuseSphere sphere = sphere_of(facts).sphere;
      fuzz::require(sphere.radius_m >= 0 && std::isfinite(sphere.radius_m));
      fuzz::require(sphere.albedo > 0 && sphere.albedo <= 1);
    }
    const std::string known = facts_csv(parse_object_facts(text, "fuzz"));
    fuzz::require(facts_csv(parse_object_facts(known, "fuzz")) == known);
    for (const SizeKind kind : {SizeKind::radius, SizeKind::rcs})
      import_facts(text, "fuzz",
                   {.id = "NORAD_CAT_ID",
                    .size = "rcs_m2",
                    .kind = kind,
                    .unit = kind == SizeKind::rcs ? SizeUnit::dbsm : SizeUnit::mm});
  } catch (const ConfigError&) {
  }
  return 0;
}
