#include "core/exchange/csv.h"

#include <map>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/files/json_record.h"
#include "core/base/files/text_fields.h"
#include "core/exchange/export_format.h"

namespace dmise {
namespace {

using Json = nlohmann::ordered_json;

/// A table whose columns appear as rows need them.
class Table {
 public:
  void begin_row() { rows_.emplace_back(); }
  void put(const std::string& column, std::string cell) {
    const auto place = place_.emplace(column, columns_.size());
    if (place.second) columns_.push_back(formula_free(column));
    auto& row = rows_.back();
    if (row.size() <= place.first->second) row.resize(place.first->second + 1);
    row[place.first->second] = std::move(cell);
  }
  std::string text() const {
    if (columns_.empty()) return "";
    std::string out;
    const auto line = [&](const std::vector<std::string>& cells) {
      for (std::size_t i = 0; i < columns_.size(); ++i)
        out += (i > 0 ? "," : "") + (i < cells.size() ? csv_field(cells[i]) : "");
      out += "\r\n";
    };
    line(columns_);
    for (const auto& row : rows_) line(row);
    return out;
  }

 private:
  std::vector<std::string> columns_;
  std::map<std::string, std::size_t> place_;
  std::vector<std::vector<std::string>> rows_;
};

std::string suffix(const std::string& key, std::size_t size, std::size_t i) {
  constexpr const char* axes[] = {"_x", "_y", "_z"};
  constexpr const char* pairs[] = {"_xx", "_xy", "_yy"};
  const bool numbers = size > 3 || size < 2;
  if (numbers) return "_" + std::to_string(i + 1);
  return key.find("covariance") != std::string::npos ? pairs[i] : axes[i];
}

void put(const std::string& key, const Json& value, Table& table) {
  if (value.is_object()) {
    for (const auto& [name, inner] : value.items())
      put(key + (key.empty() ? "" : "_") + name, inner, table);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i)
      put(key + suffix(key, value.size(), i), value[i], table);
  } else if (value.is_string()) {
    table.put(key, formula_free(value.get<std::string>()));
  } else if (value.is_number_float()) {
    table.put(key, JsonWriter().value(value.get<double>()).take());
  } else {
    table.put(key, value.is_null() ? "" : value.dump());
  }
}

std::string csv_of(const std::string& path, const RunProducts& run) {
  Table table;
  const auto add = [&](const std::string& line, const std::string& place) {
    const auto row = Json::parse(line, nullptr, false);
    if (!row.is_object()) throw ConfigError(place + ": must be a JSON object");
    const auto sensor = row.find("sensor"), frame = row.find("frame");
    if (sensor == row.end() || !sensor->is_string() || frame == row.end() ||
        !frame->is_number_unsigned() ||
        !run.frame_index.contains({sensor->get<std::string>(), frame->get<std::uint32_t>()}))
      return;  // its sensor is not wanted
    table.begin_row();
    put("", row, table);
  };
  for_line_texts(path, quietly, add);
  return table.text();
}

}  // namespace

std::vector<ExportedFile> csv_files(const ExportRequest& request) {
  std::vector<ExportedFile> files;
  for (const std::string name : {name_of(request.kind), "frames"})
    files.push_back(
        {name + ".csv", csv_of(request.run.directory + "/" + name + ".jsonl", request.run), ""});
  return files;
}

}  // namespace dmise
