#pragma once
#include <array>
#include <string>
#include <string_view>

#include "core/orbit/elements/object_facts.h"

namespace dmise {

/// What the sizes of somebody's table are.
enum class SizeKind { radius, diameter, rcs };
enum class SizeUnit { m, cm, mm, m2, dbsm };

/// Names of the columns of a table of sizes, and what they hold. An empty name: none.
struct FactsColumns {
  std::string id = "NORAD_CAT_ID";  // catalogue numbers
  std::string size;
  SizeKind kind = SizeKind::diameter;
  SizeUnit unit = SizeUnit::m;              // for sizes; a length also for dimensions
  std::array<std::string, 3> dimensions{};  // length, width, height, in place of a size
  std::string albedo, standard_magnitude;
};

struct ImportedFacts {
  ObjectFactsFile file;
  std::size_t rows = 0;
  std::size_t unknown = 0;  // rows of which nothing is known
};

/// Reads facts from a CSV with a header of somebody's columns. Blank fields, and sizes of 0, are
/// unknown. Rows that are wrong, or of an object that there was, are refused with the column.
/// Throws `ConfigError` if a column is missing (with those that there are), or if the kind has no
/// such unit.
ImportedFacts import_facts(std::string_view text, const std::string& source,
                           const FactsColumns& columns);

/// The facts as the CSV that a scenario's `facts` takes, by catalogue number.
std::string facts_csv(const ObjectFactsFile& file);

}  // namespace dmise
