#include <array>
#include <cmath>

#include "core/base/files/json.h"
#include "core/base/formatted.h"
#include "core/camera_calibration/detector/camera_calibration.h"

namespace dmise {
namespace {

/// A value with the digits that its deviation allows, two of it.
std::string digits_of(const CameraQuantity& q) {
  if (q.value == std::floor(q.value) && std::abs(q.value) < 1e9 && !q.sigma)
    return formatted("%.0f", q.value);
  if (!q.sigma || !(*q.sigma > 0)) return formatted("%.6g", q.value);
  const double relative = std::abs(q.value) / *q.sigma;
  const int digits = relative > 1 ? std::min(9, int(std::log10(relative)) + 3) : 2;
  return formatted("%.*g", digits, q.value);
}

/// One line of a comment: what cards and names say may hold anything.
std::string plain(std::string text) {
  for (char& c : text)
    if (c < ' ' || c > '~') c = ' ';
  return text;
}

/// A text as a YAML scalar in quotes.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : plain(text)) out += c == '\'' ? "''" : std::string(1, c);
  return out + "'";
}

std::string comment_of(const CameraQuantity& q) {
  std::string text;
  if (q.sigma) text += formatted("+- %.2g, ", *q.sigma);
  text += q.origin == ValueOrigin::measured ? "" : std::string(name_of(q.origin)) + ": ";
  return plain(text + q.how);
}

std::string list_of(const std::vector<double>& values, const char* format) {
  std::string out = "[";
  for (const double v : values) {
    if (out.size() > 1) out += ", ";
    char text[32];
    std::snprintf(text, sizeof text, format, v);
    out += text;
  }
  return out + "]";
}

/// Values, and their deviations.
std::pair<std::vector<double>, std::vector<double>> lists_of(
    const std::vector<MeasuredValue>& measured) {
  std::pair<std::vector<double>, std::vector<double>> out;
  for (const MeasuredValue& m : measured) {
    out.first.push_back(m.value);
    out.second.push_back(m.sigma);
  }
  return out;
}

/// The lines of one mapping of the file and of the mappings in it.
void add_mapping(const CameraCalibration& camera, const std::string& prefix, int indent,
                 std::string& out) {
  const std::string margin(std::size_t(indent), ' ');
  std::string inner;  // the mapping in this one that is open
  for (const CameraQuantity& q : camera.quantities) {
    if (!q.key.starts_with(prefix)) continue;
    std::string key = q.key.substr(prefix.size());
    std::string more = margin;
    const std::size_t dot = key.find('.');
    if (q.origin == ValueOrigin::insignificant) {
      more += "# ";
    } else if (dot != std::string::npos) {
      if (inner != key.substr(0, dot)) {
        inner = key.substr(0, dot);
        out += margin + inner + ":\n";
      }
      key = key.substr(dot + 1);
      more += "  ";
    }
    out += more + key + ": " + digits_of(q) + "  # " + comment_of(q) + "\n";
  }
  for (const CameraTable& table : camera.tables) {
    if (!table.key.starts_with(prefix)) continue;
    out += margin + table.key.substr(prefix.size()) + ":  # " + plain(table.how) + "\n";
    out += margin + "  radius_px: " + list_of(table.radius_px, "%.1f") + "\n";
    for (const CameraTable::Column& column : table.columns) {
      const auto [values, sigmas] = lists_of(column.values);
      out += margin + "  " + column.key + ": " + list_of(values, "%.5g") + "  # +- " +
             list_of(sigmas, "%.2g") + "\n";
    }
  }
}

}  // namespace

const char* name_of(ValueOrigin origin) {
  static constexpr std::array names{"measured", "insignificant", "header", "stated", "assumed"};
  return names[std::size_t(origin)];
}

const CameraQuantity* CameraCalibration::find(const std::string& key) const {
  for (const CameraQuantity& q : quantities)
    if (q.key == key) return &q;
  return nullptr;
}

std::string to_yaml(const CameraCalibration& camera) {
  std::string out =
      "# Written by dmise calibrate. Behind each value: its standard deviation, and "
      "how it was found.\n";
  for (const std::string& note : camera.notes) out += "# note: " + plain(note) + "\n";
  out += "name: " + quoted(camera.name) + "\nsource: " + quoted(camera.source) + "\n";
  out += "optics:\n  projection: " + camera.projection + "\n";
  add_mapping(camera, "optics.", 2, out);
  out += "detector:\n";
  add_mapping(camera, "detector.", 2, out);
  return out + "band: " + quoted(camera.band) + "\n";
}

std::string to_json(const CameraCalibration& camera) {
  JsonWriter json;
  json.begin_object();
  json.field("name", plain(camera.name)).field("projection", camera.projection);
  json.field("band", plain(camera.band));
  json.key("quantities").begin_object();
  for (const CameraQuantity& q : camera.quantities) {
    json.key(q.key).begin_object();
    json.field("value", q.value).field("sigma", q.sigma).field("unit", q.unit);
    json.field("frames", q.frames).field("origin", name_of(q.origin)).field("how", plain(q.how));
    json.end_object();
  }
  json.end_object();
  json.key("tables").begin_object();
  for (const CameraTable& table : camera.tables) {
    json.key(table.key).begin_object();
    json.list("radius_px", table.radius_px);
    for (const CameraTable::Column& column : table.columns) {
      const auto [values, sigmas] = lists_of(column.values);
      json.list(column.key, values);
      json.list(column.key + "_sigma", sigmas);
    }
    json.end_object();
  }
  json.end_object();
  std::vector<std::string> notes;
  for (const std::string& note : camera.notes) notes.push_back(plain(note));
  json.list("notes", notes);
  json.end_object();
  return json.take();
}

std::string to_table(const CameraCalibration& camera) {
  std::string out;
  for (const CameraQuantity& q : camera.quantities) {
    const std::string sigma = q.sigma ? formatted("+- %.2g", *q.sigma) : "";
    out += formatted("%-34s %14s %-12s %-6s %s%s\n", q.key.c_str(), digits_of(q).c_str(),
                     sigma.c_str(), q.unit.c_str(),
                     q.origin == ValueOrigin::measured ? "" : name_of(q.origin),
                     ((q.origin == ValueOrigin::measured ? "" : ": ") + plain(q.how)).c_str());
  }
  for (const CameraTable& table : camera.tables)
    for (const CameraTable::Column& column : table.columns) {
      out += formatted("%-34s", (table.key + "." + column.key).c_str());
      for (const MeasuredValue& m : column.values) out += formatted(" %.4g", m.value);
      out +=
          "  to " + formatted("%.0f px", table.radius_px.back()) + ": " + plain(table.how) + "\n";
    }
  return out;
}

}  // namespace dmise
