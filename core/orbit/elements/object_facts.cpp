#include "core/orbit/elements/object_facts.h"

#include <algorithm>
#include <cmath>

#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/base/units.h"
#include "core/orbit/elements/record.h"

namespace dmise {

namespace {

/// Place of each column by its name in upper case.
using Columns = std::map<std::string, std::size_t>;

Columns columns_of(std::string_view header) {
  Columns columns;
  const std::vector<std::string> names = csv_fields(header);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = upper_case(trimmed(names[i]));
    columns[name == "NORAD_CAT_ID" ? "CATALOGUE_NUMBER" : name] = i;
  }
  return columns;
}

ObjectFacts facts_of(const std::vector<std::string>& row, const Columns& columns) {
  const auto value = [&](const char* what, double low, double high) -> std::optional<double> {
    const auto column = columns.find(upper_case(what));
    if (column == columns.end() || trimmed(row[column->second]).empty()) return std::nullopt;
    return real_in(row[column->second], what, low, high);
  };
  ObjectFacts facts;
  facts.standard_magnitude = value("standard_magnitude", -10, 40);
  facts.rcs_m2 = value("rcs_m2", 0, 1e6);
  facts.dimensions_m = {value("length_m", 0, 1e4).value_or(0), value("width_m", 0, 1e4).value_or(0),
                        value("height_m", 0, 1e4).value_or(0)};
  facts.albedo = value("albedo", 1e-6, 1);
  return facts;
}

/// Mean cross-section over all directions: a quarter of a convex body's surface (Cauchy).
double mean_cross_section_m2(std::array<double, 3> d) {
  std::sort(d.begin(), d.end(), std::greater<>());
  if (d[1] == 0) return pi * d[0] * d[0] / 4;                           // sphere
  if (d[2] == 0) return (pi * d[1] * d[0] + pi * d[1] * d[1] / 2) / 4;  // cylinder: diameter d[1]
  return (d[0] * d[1] + d[1] * d[2] + d[2] * d[0]) / 2;                 // box
}

}  // namespace

ObjectFactsFile parse_object_facts(std::string_view text, const std::string& source) {
  ObjectFactsFile file{source, {}, {}};
  std::optional<Columns> columns;
  std::size_t width = 0;
  LineReader lines(without_byte_order_mark(text));
  while (const auto next = lines.next()) {
    if (trimmed(*next).empty() || (*next)[0] == '#') continue;
    if (!columns) {
      columns = columns_of(*next);
      width = csv_fields(*next).size();
      if (!columns->contains("CATALOGUE_NUMBER"))
        throw ConfigError(at_line(source, lines.line(), "no column catalogue_number" + got(*next)));
      continue;
    }
    try {
      const std::vector<std::string> row = csv_fields(*next);
      if (row.size() != width) throw RecordError("not as many fields as the header" + got(*next));
      const std::string_view number = trimmed(row[columns->at("CATALOGUE_NUMBER")]);
      const auto catalogue_number = parse_count(number);
      if (!catalogue_number) throw RecordError("catalogue_number is not a number" + got(number));
      if (!file.facts.try_emplace(*catalogue_number, facts_of(row, *columns)).second)
        throw RecordError("a second row of this object" + got(number));
    } catch (const RecordError& error) {
      file.refused.push_back({lines.line(), error.what()});
    }
  }
  if (!columns) throw ConfigError(source + ": has no header");
  return file;
}

ObjectFactsFile read_object_facts(const std::string& path) {
  return parse_object_facts(read_text_file(path), path);
}

ObjectSphere sphere_of(const ObjectFacts& facts, const DiffuseSphere& unknown) {
  ObjectSphere result{unknown, BrightnessSource::none};
  if (facts.albedo) result.sphere.albedo = *facts.albedo;
  const double cross_section_m2 = mean_cross_section_m2(facts.dimensions_m);
  if (facts.standard_magnitude) {
    result.source = BrightnessSource::standard_magnitude;
    result.sphere.radius_m =
        radius_from_standard({.v_mag = *facts.standard_magnitude}, result.sphere.albedo);
  } else if (cross_section_m2 > 0) {
    result.source = BrightnessSource::dimensions;
    result.sphere.radius_m = std::sqrt(cross_section_m2 / pi);
  } else if (facts.rcs_m2 && *facts.rcs_m2 > 0) {
    result.source = BrightnessSource::rcs;
    result.sphere.radius_m = std::sqrt(*facts.rcs_m2 / pi);
  }
  return result;
}

}  // namespace dmise
