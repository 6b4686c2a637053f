#include <optional>

#include "core/base/files/text_fields.h"
#include "core/orbit/elements/tle.h"

namespace dmise {

namespace {

/// Whether a line is meant as line `number` of an element set rather than a name such as
/// "1KUNS-PF".
bool is_element_line(std::string_view line, char number) {
  if (line.size() < 8 || line[0] != number || line[1] != ' ') return false;
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t i = 3; i < 6; ++i)
    if (!digit(line[i]) && line[i] != ' ') return false;
  return digit(line[6]);
}

std::string name_from(std::string_view line) {
  line = trimmed(line);
  if (line.size() >= 2 && line.substr(0, 2) == "0 ") line = trimmed(line.substr(2));
  return std::string(line);
}

struct NumberedLine {
  int number = 0;  // 0: none
  std::string_view text;
};

void add_record(const NumberedLine& line1, const NumberedLine& line2, std::string_view name,
                bool lenient, CatalogueFile& file) {
  std::string warning;
  try {
    MeanElements elements = parse_tle(line1.text, line2.text, lenient, &warning);
    elements.name = name;
    file.elements.push_back(std::move(elements));
    if (!warning.empty()) file.warnings.push_back({line1.number, warning});
  } catch (const RecordError& error) {
    file.refused.push_back({line1.number, error.what()});
  }
}

}  // namespace

void read_tle(std::string_view text, bool lenient, CatalogueFile& file) {
  NumberedLine name, line1;
  const auto refuse = [&](NumberedLine& line, const char* reason) {
    if (line.number) file.refused.push_back({line.number, reason + got(line.text)});
    line = {};
  };
  LineReader lines(text);
  while (const auto next = lines.next()) {
    const NumberedLine line{lines.line(), *next};
    if (trimmed(line.text).empty() || line.text[0] == '#') continue;
    if (line1.number && is_element_line(line.text, '2')) {
      add_record(line1, line, name_from(name.text), lenient, file);
      line1 = {};
      name = {};
      continue;
    }
    if (line1.number) name = {};  // the name belongs to the refused line 1
    refuse(line1, "line 1 without a line 2 after it");
    if (is_element_line(line.text, '1')) {
      line1 = line;
    } else if (is_element_line(line.text, '2')) {
      name = {};
      file.refused.push_back({line.number, "line 2 without a line 1 before it" + got(line.text)});
    } else {
      refuse(name, "neither an element line nor the name of one");
      name = line;
    }
  }
  if (line1.number) name = {};
  refuse(line1, "line 1 without a line 2 after it");
  refuse(name, "neither an element line nor the name of one");
}

void read_gpredict(std::string_view text, bool lenient, CatalogueFile& file) {
  struct Section {
    NumberedLine header, line1, line2;
    std::string_view name;
  };
  std::optional<Section> section;
  const auto finish = [&] {
    if (!section) return;
    if (!section->line1.number || !section->line2.number)
      file.refused.push_back(
          {section->header.number, "section without TLE1 and TLE2" + got(section->header.text)});
    else
      add_record(section->line1, section->line2, section->name, lenient, file);
  };
  LineReader lines(text);
  while (const auto next = lines.next()) {
    const std::string_view line = trimmed(*next);
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == '[') {
      finish();
      section = Section{.header = {lines.line(), line}};
      continue;
    }
    const std::size_t equals = line.find('=');
    if (!section || equals == std::string_view::npos) {
      file.refused.push_back({lines.line(), "neither a [section] nor KEY=value" + got(line)});
      continue;
    }
    const std::string_view key = trimmed(line.substr(0, equals));
    const std::string_view value = trimmed(line.substr(equals + 1));
    if (key == "NAME") section->name = value;
    if (key == "TLE1") section->line1 = {lines.line(), value};
    if (key == "TLE2") section->line2 = {lines.line(), value};
  }
  finish();
}

}  // namespace dmise
