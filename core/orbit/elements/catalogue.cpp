#include "core/orbit/elements/catalogue.h"

#include <array>
#include <unordered_map>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/orbit/elements/epoch.h"
#include "core/orbit/elements/omm.h"
#include "core/orbit/elements/tle.h"

namespace dmise {

namespace {

/// First line that is neither blank nor a comment.
std::string_view first_line(std::string_view text) {
  LineReader lines(text);
  while (const auto line = lines.next())
    if (!trimmed(*line).empty() && trimmed(*line)[0] != '#') return trimmed(*line);
  return {};
}

CatalogueFormat format_of(std::string_view text, const std::string& source) {
  const std::string_view line = first_line(text);
  if (line.empty()) throw ConfigError(source + ": contains no element sets");
  if (line[0] == '[' && line.size() > 1 && line[1] >= '0' && line[1] <= '9')
    return CatalogueFormat::gpredict;
  if (line[0] == '[' || line[0] == '{') return CatalogueFormat::omm_json;
  if (line[0] == '<') return CatalogueFormat::omm_xml;
  if (line.substr(0, 14) == "CCSDS_OMM_VERS") return CatalogueFormat::omm_kvn;
  if (line.substr(0, 6) == "CCSDS_")
    throw ConfigError(source + ": contains no mean elements" + got(line));
  const std::string header = upper_case(line);
  if (header.find("NORAD_CAT_ID") != std::string::npos && header.find(',') != std::string::npos)
    return CatalogueFormat::omm_csv;
  return CatalogueFormat::tle;
}

/// Keeps the newest set of each object, at its place in the file.
void keep_newest(CatalogueFile& file) {
  std::unordered_map<std::uint32_t, std::size_t> newest;  // catalogue number -> index
  std::vector<bool> dropped(file.elements.size(), false);
  for (std::size_t i = 0; i < file.elements.size(); ++i) {
    const MeanElements& e = file.elements[i];
    if (e.catalogue_number == 0) continue;
    const auto [place, first] = newest.try_emplace(e.catalogue_number, i);
    if (first) continue;
    const MeanElements& other = file.elements[place->second];
    const bool newer =
        epoch_days_between({other.epoch_jd1, other.epoch_jd2}, {e.epoch_jd1, e.epoch_jd2}) >= 0;
    dropped[newer ? place->second : i] = true;
    if (newer) place->second = i;
    ++file.superseded;
  }
  if (file.superseded == 0) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < file.elements.size(); ++i) {
    if (dropped[i]) continue;
    if (kept != i) file.elements[kept] = std::move(file.elements[i]);
    ++kept;
  }
  file.elements.resize(kept);
}

}  // namespace

const char* name_of(CatalogueFormat format) {
  constexpr std::array names = {"TLE/3LE",   "gpredict",  "OMM (JSON)",
                                "OMM (CSV)", "OMM (XML)", "OMM (KVN)"};
  return names[static_cast<std::size_t>(format)];
}

std::string CatalogueFile::describe(const CatalogueProblem& problem) const {
  return at_line(source, problem.line, problem.reason);
}

CatalogueFile parse_catalogue(std::string_view text, const std::string& source,
                              const CatalogueOptions& options) {
  text = without_byte_order_mark(text);
  CatalogueFile file;
  file.source = source;
  file.format = format_of(text, source);
  switch (file.format) {
    case CatalogueFormat::tle:
      read_tle(text, options.lenient, file);
      break;
    case CatalogueFormat::gpredict:
      read_gpredict(text, options.lenient, file);
      break;
    case CatalogueFormat::omm_json:
      read_omm_json(text, file);
      break;
    case CatalogueFormat::omm_csv:
      read_omm_csv(text, file);
      break;
    case CatalogueFormat::omm_xml:
      read_omm_xml(text, file);
      break;
    case CatalogueFormat::omm_kvn:
      read_omm_kvn(text, file);
      break;
  }
  if (options.until)
    file.superseded += std::erase_if(file.elements, [&](const MeanElements& e) {
      return epoch_days_between(*options.until, {e.epoch_jd1, e.epoch_jd2}) > 0;
    });
  if (!options.keep_every_epoch) keep_newest(file);
  return file;
}

CatalogueFile read_catalogue(const std::string& path, const CatalogueOptions& options) {
  return parse_catalogue(read_text_file(path), path, options);
}

}  // namespace dmise
