#include "core/sky/star_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace dmise::star_text {

std::string_view trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::string_view columns(std::string_view line, std::size_t first, std::size_t last) {
  if (first > line.size()) return {};
  return trim(line.substr(first - 1, last - first + 1));
}

std::optional<double> number(std::string_view field) {
  if (!field.empty() && field.front() == '+') field.remove_prefix(1);
  double value = 0.0;
  const char* end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, value);
  if (field.empty() || error != std::errc{} || stop != end || !std::isfinite(value))
    return std::nullopt;
  return value;
}

void split_csv(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (line[i] != ',' || quoted)) continue;
    std::string_view field = trim(line.substr(begin, i - begin));
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
      field = trim(field.substr(1, field.size() - 2));
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
  const auto w = number(whole), m = number(minutes), s = number(seconds);
  if (!w || !m || !s || *w < 0 || *m < 0 || *m >= 60 || *s < 0 || *s > 60) return std::nullopt;
  return *w + *m / 60 + *s / 3600;
}

std::string problem(const std::string& file, std::size_t line, std::string_view reason) {
  return file + ":" + std::to_string(line) + ": " + std::string(reason);
}

}  // namespace dmise::star_text
