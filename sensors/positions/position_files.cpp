#include "sensors/positions/position_files.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/files/whole_file.h"
#include "core/run/run_files.h"

namespace dmise {
namespace {

[[noreturn]] void fail(const std::string& path) {
  throw Error(path + ": can't be written: " + std::strerror(errno));
}

std::string file_name(const ObjectInfo& object) {
  std::string name = object.name;
  for (char& c : name)
    if (!(std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')) c = '_';
  return name + "-" + std::to_string(object.catalogue_number) + ".oem";
}

}  // namespace

PositionFiles::PositionFiles(std::string directory, const OutputConfig& output,
                             std::string creation_date)
    : directory_(std::move(directory)),
      creation_date_(std::move(creation_date)),
      with_oem_(output.positions_oem),
      in_enu_(output.positions_enu) {
  if (output.positions_csv) csv_.path = path_in(directory_, run_file::positions_csv);
  if (output.positions_jsonl) json_.path = path_in(directory_, run_file::positions);
  make_directories(with_oem_ ? directory_ + "/positions" : directory_);
}

PositionFiles::~PositionFiles() {
  for (const Table* table : {&csv_, &json_})
    if (table->file) std::fclose(table->file);
}

void PositionFiles::open_ephemerides(const std::vector<ObjectInfo>& objects) {
  if (!with_oem_) return;
  for (const auto& object : objects)
    ephemerides_[object.catalogue_number] = std::make_unique<OemFile>(
        directory_ + "/positions/" + file_name(object),
        OemSubject{.object_name = object.name,
                   .object_id = object.designator.empty() ? std::to_string(object.catalogue_number)
                                                          : object.designator,
                   .creation_date = creation_date_});
}

void PositionFiles::keep_before(Tick tick, const std::string& utc) {
  if (!csv_.path.empty()) keep_lines_before(csv_, tick, csv_header(in_enu_));
  if (!json_.path.empty()) keep_lines_before(json_, tick, "");
  for (const auto& [number, file] : ephemerides_) file->keep_before(utc);
}

void PositionFiles::keep_lines_before(Table& table, Tick tick, const std::string& header) {
  std::string kept = header;
  {
    std::ifstream file(table.path);
    std::string line;
    while (std::getline(file, line) && !file.eof())
      if (const auto of = tick_of_line(line); of && *of < tick) kept += line + "\n";
  }
  write_file_whole(table.path, kept);
  table.file = std::fopen(table.path.c_str(), "ab");
  if (!table.file) fail(table.path);
}

void PositionFiles::append(Table& table, const std::string& lines) {
  if (std::fwrite(lines.data(), 1, lines.size(), table.file) != lines.size() ||
      std::fflush(table.file) != 0)
    fail(table.path);
}

void PositionFiles::add(const std::vector<PositionRow>& rows, const std::string& previous_utc) {
  std::string csv, json;
  for (const auto& row : rows) {
    if (csv_.file) csv += csv_line(row);
    if (json_.file) json += json_line(row);
    const auto ephemeris = ephemerides_.find(row.catalogue_number);
    if (row.kind == "object" && ephemeris != ephemerides_.end())
      ephemeris->second->add(row.time_utc, previous_utc, row.position_m, *row.slope_m_per_s);
  }
  if (csv_.file) append(csv_, csv);
  if (json_.file) append(json_, json);
}

Tick last_tick_written(const std::string& directory) {
  Tick last = -1;
  for (const RunFile& table : {run_file::positions_csv, run_file::positions}) {
    std::ifstream file(path_in(directory, table));
    std::string line;
    Tick here = -1;
    while (std::getline(file, line) && !file.eof())
      if (const auto tick = tick_of_line(line)) here = *tick;
    if (here >= 0) last = last < 0 ? here : std::min(last, here);
  }
  return last;
}

}  // namespace dmise
