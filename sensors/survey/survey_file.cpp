#include "sensors/survey/survey_file.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/digest.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/base/formatted.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr const char* exposure_columns =
    "frame,middle_ns,middle_utc,sun_elevation_rad,in_field,sunlit,expected_detections";
constexpr const char* map_columns_line =
    "shell,row,column,south_deg,west_deg,looks,expected_detections_2e20,shell_name";
constexpr const char* pass_columns =
    "object,catalogue_number,first_ns,last_ns,first_utc,exposures,expected_detections,log_miss,"
    "best_snr";

/// A file of fields, line by line; turns bad at the first that does not fit.
class Reader {
 public:
  Reader(const std::string& path, const std::string& head, const char* columns) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return;
    std::istringstream lines(read_text_file(path));
    std::string line;
    if (!std::getline(lines, line) || line != "# " + head) return;
    has_head_ = true;
    if (!std::getline(lines, totals_)) return;
    body_ = lines.str().substr(std::size_t(std::max<std::streamoff>(0, lines.tellg())));
    if (!std::getline(lines, line) || line != columns) return;
    while (std::getline(lines, line)) lines_.push_back(std::move(line));
    good_ = true;
  }
  bool has_head() const { return has_head_; }
  bool good() const { return good_; }
  const std::string& body() const { return body_; }
  void spoil() { good_ = false; }
  const std::string& totals() const { return totals_; }

  template <class Take>
  void each(const Take& take) {
    for (const std::string& line : lines_) {
      rest_ = line;
      take();
      if (!good_) return;
    }
  }
  std::string_view text() {
    const std::size_t comma = rest_.find(',');
    const std::string_view field = rest_.substr(0, comma);
    rest_ = comma == std::string_view::npos ? std::string_view() : rest_.substr(comma + 1);
    return field;
  }
  template <class T>
  T number() {
    return number_of<T>(text());
  }
  template <class T>
  T number_of(std::string_view field) {
    T value{};
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size()) good_ = false;
    return value;
  }

 private:
  bool has_head_ = false, good_ = false;
  std::string totals_, body_;  // the second line; what follows it
  std::vector<std::string> lines_;
  std::string_view rest_;
};

/// The digest of a survey's tables.
std::string digest_of(const std::string& exposures, const std::string& map,
                      const std::string& passes) {
  Sha256 digest;
  for (const std::string* table : {&exposures, &map, &passes}) digest.update(*table);
  return digest.hex().substr(0, 32);
}

}  // namespace

void write_survey(const std::string& directory, const std::string& head, const SensorSurvey& survey,
                  const SurveyScene& scene, const Shells& shells) {
  make_directories(directory);
  const auto utc = [&](SimTime t) { return format_utc(scene.clock().utc(t), 3); };
  std::string exposures = exposure_columns + std::string("\n");
  for (const auto& e : survey.exposures)
    exposures += std::to_string(e.frame) + "," + std::to_string(e.middle.ns) + "," + utc(e.middle) +
                 "," + (e.sun_elevation_rad ? shortest_text(*e.sun_elevation_rad) : "") + "," +
                 std::to_string(e.in_field) + "," + std::to_string(e.sunlit) + "," +
                 shortest_text(e.expected) + "\n";
  std::string map = map_columns_line + std::string("\n");
  for (const auto& [key, cell] : survey.map)
    map += std::to_string(key[0]) + "," + std::to_string(key[1]) + "," + std::to_string(key[2]) +
           "," + std::to_string(180 / map_rows * key[1] - 90) + "," +
           std::to_string(360 / map_columns * key[2] - 180) + "," + std::to_string(cell.looks) +
           "," + std::to_string(cell.expected) + "," + shells.shells[key[0]].name + "\n";
  std::string passes = pass_columns + std::string("\n");
  for (const auto& p : survey.passes)
    passes += std::to_string(p.object) + "," +
              std::to_string(scene.roster()->objects[p.object].catalogue_number) + "," +
              std::to_string(p.first.ns) + "," + std::to_string(p.last.ns) + "," + utc(p.first) +
              "," + std::to_string(p.exposures) + "," + shortest_text(p.expected) + "," +
              shortest_text(p.log_miss) + "," + shortest_text(p.best_snr) + "\n";
  const std::string head_lines = "# " + head + "\n# frames " + std::to_string(survey.frames) +
                                 " without state " + std::to_string(survey.without_state) +
                                 " closed " + std::to_string(survey.closed) + " digest " +
                                 digest_of(exposures, map, passes) + "\n";
  write_file_whole(directory + "/exposures.csv", head_lines + exposures);
  write_file_whole(directory + "/map.csv", head_lines + map);
  write_file_whole(directory + "/passes.csv", head_lines + passes);
}

std::optional<SensorSurvey> read_survey(const std::string& directory, const std::string& head,
                                        const std::string& sensor, std::size_t objects,
                                        bool& damaged) {
  SensorSurvey survey{.sensor = sensor};
  Reader passes(directory + "/passes.csv", head, pass_columns);
  Reader exposures(directory + "/exposures.csv", head, exposure_columns);
  Reader map(directory + "/map.csv", head, map_columns_line);
  damaged = passes.has_head() || exposures.has_head() || map.has_head();
  if (!passes.good() || !exposures.good() || !map.good()) return std::nullopt;
  std::istringstream totals(passes.totals());
  std::string hash, word, digest;
  totals >> hash >> word >> survey.frames >> word >> word >> survey.without_state >> word >>
      survey.closed >> word >> digest;
  if (!totals || digest != digest_of(exposures.body(), map.body(), passes.body()))
    return std::nullopt;
  passes.each([&] {
    SurveyPass p;
    p.object = passes.number<std::uint32_t>();
    passes.text();
    p.first.ns = passes.number<std::int64_t>();
    p.last.ns = passes.number<std::int64_t>();
    passes.text();
    p.exposures = passes.number<std::uint32_t>();
    p.expected = passes.number<double>();
    p.log_miss = passes.number<double>();
    p.best_snr = passes.number<double>();
    if (p.object >= objects) passes.spoil();
    survey.passes.push_back(p);
  });
  exposures.each([&] {
    SurveyExposure e;
    e.frame = exposures.number<std::uint32_t>();
    e.middle.ns = exposures.number<std::int64_t>();
    exposures.text();
    if (const std::string_view sun = exposures.text(); !sun.empty())
      e.sun_elevation_rad = exposures.number_of<double>(sun);
    e.in_field = exposures.number<std::uint32_t>();
    e.sunlit = exposures.number<std::uint32_t>();
    e.expected = exposures.number<double>();
    survey.exposures.push_back(e);
  });
  map.each([&] {
    std::array<std::uint16_t, 3> key;
    for (auto& k : key) k = map.number<std::uint16_t>();
    map.text();
    map.text();
    MapCell& cell = survey.map[key];
    cell.looks = map.number<std::uint64_t>();
    cell.expected = map.number<std::uint64_t>();
  });
  if (!passes.good() || !exposures.good() || !map.good()) return std::nullopt;
  damaged = false;
  return survey;
}

}  // namespace dmise
