#include "core/sky/stars/star_text.h"

#include <algorithm>

namespace dmise::star_text {

std::string_view columns(std::string_view line, std::size_t first, std::size_t last) {
  if (first > line.size()) return {};
  return trimmed(line.substr(first - 1, last - first + 1));
}

void split_csv(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (line[i] != ',' || quoted)) continue;
    std::string_view field = trimmed(line.substr(begin, i - begin));
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
      field = trimmed(field.substr(1, field.size() - 2));
    fields.push_back(field);
    begin = i + 1;
  }
}

std::vector<int> find_columns(const std::vector<std::string_view>& header,
                              const std::vector<std::string_view>& names) {
  std::vector<int> places;
  for (const std::string_view name : names) {
    const auto found = std::find(header.begin(), header.end(), name);
    places.push_back(found == header.end() ? -1 : int(found - header.begin()));
  }
  return places;
}

std::optional<double> sexagesimal(std::string_view whole, std::string_view minutes,
                                  std::string_view seconds) {
  const auto w = parse_real(whole), m = parse_real(minutes), s = parse_real(seconds);
  if (!w || !m || !s || *w < 0 || *m < 0 || *m >= 60 || *s < 0 || *s > 60) return std::nullopt;
  return *w + *m / 60 + *s / 3600;
}

}  // namespace dmise::star_text
