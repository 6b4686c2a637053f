#include "core/config/yaml/cn2_file.h"

#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/sky/stars/star_text.h"

namespace dmise {

Cn2Table parse_cn2(std::string_view text, const std::string& name) {
  Cn2Table table;
  bool header_read = false;
  std::vector<std::string_view> fields;
  star_text::for_lines(text, [&](std::string_view line, int number) {
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) return;
    const auto fail = [&](const char* reason) {
      throw ConfigError(at_line(name, number, reason) + ", got " + std::string(line));
    };
    star_text::split_csv(line, fields);
    if (!header_read) {
      if (fields.size() < 2 || fields[0] != "height_m" || fields[1] != "cn2")
        fail("the first line must be height_m,cn2");
      header_read = true;
      return;
    }
    if (fields.size() < 2) fail("must be a height and a Cn2");
    const auto height = parse_real(fields[0]), cn2 = parse_real(fields[1]);
    if (!height || !(*height >= 0) || (!table.height_m.empty() && *height <= table.height_m.back()))
      fail("heights must be >= 0 and ascend");
    if (!cn2 || !(*cn2 > 0)) fail("Cn2 must be > 0");
    table.height_m.push_back(*height);
    table.cn2.push_back(*cn2);
  });
  if (table.height_m.size() < 2)
    throw ConfigError(name + ": a profile needs a header and two lines or more");
  return table;
}

}  // namespace dmise
