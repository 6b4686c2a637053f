#include "core/base/files/text_fields.h"
#include "core/orbit/elements/omm.h"

namespace dmise {

void read_omm_csv(std::string_view text, CatalogueFile& file) {
  LineReader lines(text);
  std::vector<std::string> keys;
  while (const auto next = lines.next()) {
    if (trimmed(*next).empty()) continue;
    const std::vector<std::string> values = csv_fields(*next);
    if (keys.empty()) {
      for (const std::string& key : values) keys.push_back(upper_case(trimmed(key)));
      continue;
    }
    if (values.size() != keys.size()) {
      file.refused.push_back({lines.line(), std::to_string(values.size()) +
                                                " fields, but the header has " +
                                                std::to_string(keys.size()) + got(*next)});
      continue;
    }
    OmmFields omm;
    for (std::size_t i = 0; i < keys.size(); ++i) omm.set(keys[i], values[i]);
    add_omm(omm, lines.line(), file);
  }
}

void read_omm_kvn(std::string_view text, CatalogueFile& file) {
  LineReader lines(text);
  OmmFields omm;
  int first_line = 1;
  const auto finish = [&] {
    if (!omm.empty()) add_omm(omm, first_line, file);
    omm.clear();
  };
  while (const auto next = lines.next()) {
    const std::string_view line = trimmed(*next);
    if (line.empty() || line.substr(0, 7) == "COMMENT" || line[0] == '#') continue;
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) {
      file.refused.push_back({lines.line(), "not KEY = value" + got(line)});
      continue;
    }
    const std::string key = upper_case(trimmed(line.substr(0, equals)));
    std::string_view value = trimmed(line.substr(equals + 1));
    if (key == "CCSDS_OMM_VERS") {  // starts the next message
      finish();
      first_line = lines.line();
    }
    std::string_view unit;
    const std::size_t bracket = value.find('[');
    if (bracket != std::string_view::npos && bracket > 0 && value.back() == ']' &&
        key != "OBJECT_NAME") {
      unit = value.substr(bracket + 1, value.size() - bracket - 2);
      value = trimmed(value.substr(0, bracket));
    }
    omm.set(key, value, unit);
  }
  finish();
}

}  // namespace dmise
