#include "core/orbit/oem.h"

#include <erfa.h>

#include <algorithm>
#include <array>
#include <optional>
#include <pugixml.hpp>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/base/units.h"
#include "core/orbit/time_system.h"

namespace dmise {

namespace {

/// A line of an OEM in KVN, and its number in the file.
struct OemLine {
  int number = 0;
  std::string text;
};

std::vector<OemLine> kvn_lines(std::string_view text) {
  std::vector<OemLine> lines;
  LineReader reader(text);
  while (const auto line = reader.next())
    lines.push_back({reader.line(), std::string(trimmed(*line))});
  return lines;
}

/// Lines of an OEM in XML (CCSDS 505.0-B): metadata become KEY = value, states a line each.
/// Throws `ConfigError`.
std::vector<OemLine> xml_lines(std::string_view text, const std::string& source) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  const auto line_at = [&](std::ptrdiff_t offset) {
    const auto end = std::min(text.size(), std::size_t(std::max<std::ptrdiff_t>(offset, 0)));
    return 1 + int(std::count(text.begin(), text.begin() + std::ptrdiff_t(end), '\n'));
  };
  if (!result)
    throw ConfigError(at_line(source, line_at(result.offset),
                              std::string("invalid XML: ") + result.description()));
  std::vector<OemLine> lines;
  // Lines are counted on from the last node, which is before the next.
  int number = 1;
  std::ptrdiff_t counted = 0;
  const auto add = [&](const pugi::xml_node& node, std::string line) {
    for (const std::ptrdiff_t at = node.offset_debug(); counted < at; ++counted)
      number += text[std::size_t(counted)] == '\n';
    lines.push_back({number, std::move(line)});
  };
  const pugi::xml_node oem =
      document.child("oem") ? document.child("oem") : document.child("ndm").child("oem");
  if (oem) add(oem, std::string("CCSDS_OEM_VERS = ") + oem.attribute("version").value());
  for (const pugi::xml_node segment : oem.child("body").children("segment")) {
    add(segment, "META_START");
    for (const pugi::xml_node field : segment.child("metadata").children())
      add(field, std::string(field.name()) + " = " + field.child_value());
    const pugi::xml_node data = segment.child("data");
    add(data, "META_STOP");
    for (const pugi::xml_node state : data.children("stateVector")) {
      std::string line = state.child_value("EPOCH");
      for (const char* key : {"X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT"}) {
        const std::string unit = state.child(key).attribute("units").value();
        if (!unit.empty() && upper_case(unit) != (key[1] ? "KM/S" : "KM"))
          throw ConfigError(at_line(source, line_at(state.child(key).offset_debug()),
                                    "the unit of " + std::string(key) + " is not " +
                                        (key[1] ? "km/s" : "km") + got(unit)));
        line += std::string(" ") + std::string(trimmed(state.child_value(key)));
      }
      add(state, std::move(line));
    }
  }
  return lines;
}

bool is_xml(std::string_view text) {
  return trimmed(without_byte_order_mark(text).substr(0, 1000)).starts_with('<');
}

/// Parses one file from top to bottom; the members are the state of the parser.
class OemReader {
 public:
  OemReader(std::string_view text, const std::string& source)
      : lines_(is_xml(text) ? xml_lines(text, source) : kvn_lines(text)) {
    trajectory_.source = source;
  }

  Trajectory read() {
    enum class Part { header, metadata, data, covariance } part = Part::header;
    for (const OemLine& next : lines_) {
      number_ = next.number;
      const std::string_view line = next.text;
      if (line.empty() || line.substr(0, 7) == "COMMENT") continue;
      if (line == "META_START") {
        finish_segment();
        segment_.emplace();
        declared_ = {};
        part = Part::metadata;
      } else if (line == "META_STOP") {
        if (part != Part::metadata) fail("META_STOP without META_START", line);
        check_metadata();
        part = Part::data;
      } else if (line == "COVARIANCE_START") {
        if (part != Part::data) fail("COVARIANCE_START outside the ephemeris lines", line);
        part = Part::covariance;
      } else if (line == "COVARIANCE_STOP") {
        if (part != Part::covariance) fail("COVARIANCE_STOP without COVARIANCE_START", line);
        part = Part::data;
      } else if (part == Part::covariance) {
        continue;
      } else if (part == Part::data) {
        add_state(line);
      } else {
        const std::size_t equals = line.find('=');
        if (equals == std::string_view::npos) fail("neither KEY = value nor a known mark", line);
        const std::string_view key = trimmed(line.substr(0, equals));
        const std::string_view value = trimmed(line.substr(equals + 1));
        if (part == Part::metadata) metadata(key, value);
        if (key == "CCSDS_OEM_VERS") is_oem_ = true;
      }
    }
    finish_segment();
    if (!is_oem_) throw ConfigError(trajectory_.source + ": not a CCSDS OEM: no CCSDS_OEM_VERS");
    if (trajectory_.segments.empty())
      throw ConfigError(trajectory_.source + ": contains no ephemeris segment");
    return std::move(trajectory_);
  }

 private:
  struct Declared {
    bool frame = false, time = false, eme2000 = false;
    TimeSystem system;
    std::string usable_start, usable_stop;
  };

  [[noreturn]] void fail(const std::string& reason, std::string_view value) const {
    throw ConfigError(at_line(trajectory_.source, number_, reason + got(value)));
  }

  void metadata(std::string_view key, std::string_view value) {
    OemSegment& s = *segment_;
    if (key == "OBJECT_NAME") {
      s.object_name = value;
      require_one(key, value, name_);
    }
    if (key == "OBJECT_ID") require_one(key, value, id_);
    if (key == "CENTER_NAME" && upper_case(value) != "EARTH")
      fail("CENTER_NAME is not EARTH", value);
    if (key == "REF_FRAME") set_frame(upper_case(value));
    if (key == "TIME_SYSTEM") set_time_system(upper_case(value));
    if (key == "USEABLE_START_TIME" || key == "USABLE_START_TIME") declared_.usable_start = value;
    if (key == "USEABLE_STOP_TIME" || key == "USABLE_STOP_TIME") declared_.usable_stop = value;
    if (key == "INTERPOLATION") {
      const std::string kind = upper_case(value);
      if (kind == "LINEAR")
        s.interpolation = OemInterpolation::linear;
      else if (kind == "LAGRANGE")
        s.interpolation = OemInterpolation::lagrange;
      else if (kind == "HERMITE")
        s.interpolation = OemInterpolation::hermite;
      else
        fail("INTERPOLATION is not LINEAR, LAGRANGE or HERMITE", value);
    }
    if (key == "INTERPOLATION_DEGREE") {
      const auto degree = parse_integer(value);
      if (!degree || *degree < 1 || *degree > 15)
        fail("INTERPOLATION_DEGREE is not 1 to 15", value);
      s.degree = *degree;
    }
  }

  /// All segments are of one object: a file of several is not one trajectory.
  void require_one(std::string_view key, std::string_view value,
                   std::optional<std::string>& first) const {
    if (!first) first = value;
    if (*first != value)
      fail(std::string(key) + " is another than the first segment's, " + *first +
               ": a trajectory is of one object",
           value);
  }

  void set_frame(const std::string& frame) {
    declared_.frame = true;
    if (frame == "EME2000")
      declared_.eme2000 = true;
    else if (frame.substr(0, 4) == "ITRF")
      segment_->frame = OemFrame::itrs;
    else if (frame == "TEME")
      segment_->frame = OemFrame::teme;
    else if (frame != "ICRF" && frame != "GCRF")
      fail("REF_FRAME is not supported", frame);
  }

  void set_time_system(const std::string& system) {
    const auto known = time_system(system);
    if (!known) fail("TIME_SYSTEM is not supported", system);
    declared_.time = true;
    declared_.system = *known;
  }

  void check_metadata() const {
    if (!declared_.frame) fail("segment without REF_FRAME", "META_STOP");
    if (!declared_.time) fail("segment without TIME_SYSTEM", "META_STOP");
  }

  Tai time_of(std::string_view text) const {
    const auto time = tai_of(text, declared_.system);
    if (!time) fail("not a time", text);
    return *time;
  }

  void add_state(std::string_view line) {
    OemSegment& s = *segment_;
    std::array<std::string_view, 7> fields;
    std::string_view rest = line;
    std::size_t count = 0;
    while (!rest.empty()) {
      const std::size_t end = rest.find_first_of(" \t");
      if (count < fields.size()) fields[count] = rest.substr(0, end);
      ++count;
      rest = end == std::string_view::npos ? std::string_view{} : trimmed(rest.substr(end));
    }
    if (count != 7 && count != 10) fail("expected a time and 6 or 9 numbers", line);
    const Tai time = time_of(fields[0]);
    if (trajectory_.segments.empty() && s.time_s.empty()) trajectory_.reference = time;
    std::array<double, 6> value{};
    for (std::size_t i = 0; i < 6; ++i) {
      const auto number = parse_real(fields[i + 1]);
      if (!number) fail("not a number", fields[i + 1]);
      value[i] = *number * km;
    }
    const double t_s = seconds_between(trajectory_.reference, time);
    if (!s.time_s.empty() && t_s <= s.time_s.back()) fail("times must increase", fields[0]);
    s.time_s.push_back(t_s);
    s.position_m.push_back(in_gcrs_axes({value[0], value[1], value[2]}));
    s.velocity_m_per_s.push_back(in_gcrs_axes({value[3], value[4], value[5]}));
  }

  /// Rotates EME2000 to GCRS by the constant bias between them (23 mas); other frames are
  /// unchanged.
  Vec<OemAxes> in_gcrs_axes(const Vec<OemAxes>& v) const {
    if (!declared_.eme2000) return v;
    double bias[3][3], precession[3][3], both[3][3];
    eraBp06(2451545.0, 0.0, bias, precession, both);
    double from[3] = {v.x, v.y, v.z}, to[3];
    eraTrxp(bias, from, to);
    return {to[0], to[1], to[2]};
  }

  void finish_segment() {
    if (!segment_) return;
    OemSegment& s = *segment_;
    if (s.time_s.empty()) fail("a segment needs an ephemeris line", s.object_name);
    s.usable_start_s = s.time_s.front();
    s.usable_stop_s = s.time_s.back();
    if (!declared_.usable_start.empty())
      s.usable_start_s =
          std::max(s.usable_start_s,
                   seconds_between(trajectory_.reference, time_of(declared_.usable_start)));
    if (!declared_.usable_stop.empty())
      s.usable_stop_s = std::min(
          s.usable_stop_s, seconds_between(trajectory_.reference, time_of(declared_.usable_stop)));
    trajectory_.segments.push_back(std::move(s));
    segment_.reset();
  }

  std::vector<OemLine> lines_;
  int number_ = 0;  // number of the line at hand
  Trajectory trajectory_;
  std::optional<OemSegment> segment_;
  std::optional<std::string> name_, id_;  // as the first segment has them
  Declared declared_;
  bool is_oem_ = false;
};

}  // namespace

Trajectory parse_oem(std::string_view text, const std::string& source) {
  return OemReader(text, source).read();
}

Trajectory read_oem(const std::string& path) { return parse_oem(read_text_file(path), path); }

}  // namespace dmise
