#include "core/orbit/elements/facts_import.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/orbit/elements/record.h"

namespace dmise {
namespace {

constexpr double longest_m = 1e4;
constexpr double greatest_rcs_m2 = 1e6;

double metres_of(SizeUnit unit) {
  return unit == SizeUnit::cm ? 1e-2 : unit == SizeUnit::mm ? 1e-3 : 1.0;
}

bool is_length(SizeUnit unit) { return unit != SizeUnit::m2 && unit != SizeUnit::dbsm; }

/// The fields of one row by the names of their columns.
class Row {
 public:
  Row(const std::vector<std::string>& names, const std::vector<std::string>& fields)
      : names_(names), fields_(fields) {}

  std::string_view text(const std::string& column) const {
    const auto place = std::ranges::find(names_, column) - names_.begin();
    return trimmed(fields_[std::size_t(place)]);
  }

  /// Empty for no column and a blank field.
  std::optional<double> number(const std::string& column, double low, double high) const {
    if (column.empty() || text(column).empty()) return std::nullopt;
    return real_in(text(column), column.c_str(), low, high);
  }

 private:
  const std::vector<std::string>& names_;
  const std::vector<std::string>& fields_;
};

double rcs_m2(const Row& row, const FactsColumns& columns) {
  if (columns.unit == SizeUnit::m2) return row.number(columns.size, 0, greatest_rcs_m2).value_or(0);
  const auto dbsm = row.number(columns.size, -100, 60);
  return dbsm ? std::pow(10.0, *dbsm / 10) : 0.0;
}

ObjectFacts facts_of(const Row& row, const FactsColumns& columns) {
  const double metres = metres_of(columns.unit);
  ObjectFacts facts;
  if (columns.kind == SizeKind::rcs && !columns.size.empty()) {
    if (const double rcs = rcs_m2(row, columns); rcs > 0) facts.rcs_m2 = rcs;
  } else {
    const double diameters = columns.kind == SizeKind::radius ? 2.0 : 1.0;
    facts.dimensions_m[0] =
        row.number(columns.size, 0, longest_m / metres).value_or(0) * metres * diameters;
  }
  for (std::size_t i = 0; i < 3; ++i)
    if (const auto size = row.number(columns.dimensions[i], 0, longest_m / metres))
      facts.dimensions_m[i] = *size * metres;
  facts.albedo = row.number(columns.albedo, 1e-6, 1);
  facts.standard_magnitude = row.number(columns.standard_magnitude, -10, 40);
  return facts;
}

bool is_known(const ObjectFacts& facts) {
  return facts.standard_magnitude || facts.rcs_m2 || facts.albedo ||
         std::ranges::any_of(facts.dimensions_m, [](double d) { return d > 0; });
}

void require_columns(const std::vector<std::string>& names, const FactsColumns& columns,
                     const std::string& where) {
  const auto& d = columns.dimensions;
  for (const auto& wanted :
       {columns.id, columns.size, d[0], d[1], d[2], columns.albedo, columns.standard_magnitude}) {
    if (wanted.empty() || std::ranges::find(names, wanted) != names.end()) continue;
    std::string there;
    for (const auto& name : names) there += (there.empty() ? "" : ", ") + name;
    throw ConfigError(where + "no column " + wanted + ", of " + there);
  }
}

void require_unit(const FactsColumns& columns) {
  const bool rcs = !columns.size.empty() && columns.kind == SizeKind::rcs;
  if (rcs == is_length(columns.unit))
    throw ConfigError(rcs ? "a radar cross-section is in m2 or dBsm"
                          : "a length is in m, cm or mm");
}

std::uint32_t number_of(const Row& row, const std::string& column) {
  const auto number = parse_count(row.text(column));
  if (!number) throw RecordError(column + " is not a number" + got(row.text(column)));
  return *number;
}

}  // namespace

ImportedFacts import_facts(std::string_view text, const std::string& source,
                           const FactsColumns& columns) {
  require_unit(columns);
  ImportedFacts imported{.file = {source, {}, {}}};
  std::vector<std::string> names;
  LineReader lines(without_byte_order_mark(text));
  while (const auto next = lines.next()) {
    if (trimmed(*next).empty()) continue;
    const std::vector<std::string> fields = csv_fields(*next);
    if (names.empty()) {
      for (const auto& name : fields) names.emplace_back(trimmed(name));
      require_columns(names, columns, at_line(source, lines.line(), ""));
      continue;
    }
    ++imported.rows;
    try {
      if (fields.size() != names.size())
        throw RecordError("not as many fields as the header" + got(*next));
      const Row row(names, fields);
      const std::uint32_t number = number_of(row, columns.id);
      const ObjectFacts facts = facts_of(row, columns);
      if (!is_known(facts))
        ++imported.unknown;
      else if (!imported.file.facts.try_emplace(number, facts).second)
        throw RecordError("a second row of this object" + got(std::to_string(number)));
    } catch (const RecordError& error) {
      imported.file.refused.push_back({lines.line(), error.what()});
    }
  }
  if (names.empty()) throw ConfigError(source + ": has no header");
  return imported;
}

std::string facts_csv(const ObjectFactsFile& file) {
  const auto field = [](double value) { return value > 0 ? shortest_text(value) : std::string(); };
  std::string text =
      "catalogue_number,standard_magnitude,rcs_m2,length_m,width_m,height_m,albedo\n";
  for (const auto& [number, facts] : file.facts) {
    text += std::to_string(number) + "," +
            (facts.standard_magnitude ? shortest_text(*facts.standard_magnitude) : "") + "," +
            field(facts.rcs_m2.value_or(0));
    for (const double size : facts.dimensions_m) text += "," + field(size);
    text += "," + field(facts.albedo.value_or(0)) + "\n";
  }
  return text;
}

}  // namespace dmise
