#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/orbit/elements/elements.h"
#include "core/time/julian_date.h"

namespace dmise {

/// Formats of element sets, recognised by content.
enum class CatalogueFormat { tle, gpredict, omm_json, omm_csv, omm_xml, omm_kvn };

/// "TLE/3LE", "OMM (JSON)", ...
const char* name_of(CatalogueFormat format);

struct CatalogueOptions {
  /// TLE: accept lines with a wrong or missing checksum and lines truncated after the last element,
  /// with a warning each. They are refused by default: nothing else reveals a damaged line.
  bool lenient = false;
  /// Keep all element sets of an object. By default only the newest is kept and the others are
  /// counted.
  bool keep_every_epoch = false;
  /// Element sets with later epochs are left out, and counted as superseded.
  std::optional<Utc> until = {};
};

/// Why a record was refused, or a warning about one that was read.
struct CatalogueProblem {
  int line = 0;        // where the record begins, from 1
  std::string reason;  // `reason, got "value"`
};

/// A parsed catalogue. Every record is in exactly one of `elements`, `refused` and `superseded`.
struct CatalogueFile {
  std::string source;  // path, or what the caller calls the text
  CatalogueFormat format = CatalogueFormat::tle;
  std::vector<MeanElements> elements;      // in file order
  std::vector<CatalogueProblem> refused;   // records that were not read
  std::vector<CatalogueProblem> warnings;  // records that were read all the same
  std::size_t superseded = 0;  // element sets older than another of the same object, or too young

  std::size_t records() const { return elements.size() + refused.size() + superseded; }
  /// `source:line: reason`
  std::string describe(const CatalogueProblem& problem) const;
};

/// Reads a catalogue file (optionally gzip): TLE with or without names (also "0 NAME"), gpredict's
/// satellites.dat, OMM in JSON, CSV, XML or KVN. A bad record does not affect others. The later in
/// the file of two sets of one object with equal epochs is kept; number 0 (not catalogued) never
/// identifies an object. Throws `ConfigError` if the file cannot be read or has none of these
/// formats.
CatalogueFile read_catalogue(const std::string& path, const CatalogueOptions& options = {});

/// Parses a catalogue from text; `source` names it in messages.
CatalogueFile parse_catalogue(std::string_view text, const std::string& source,
                              const CatalogueOptions& options = {});

}  // namespace dmise
