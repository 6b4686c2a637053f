#include "core/exchange/czml.h"

#include <algorithm>
#include <array>
#include <map>

#include "core/base/files/json.h"
#include "core/exchange/oem.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

constexpr double field_length_m = 1.5e6;  // length of a pyramid's edges
constexpr double longest_gap_s = 600.0;   // between states that one pass joins
constexpr std::size_t max_fields = 200;   // limit for each sensor

using Colour = std::array<int, 3>;

void write_colour(JsonWriter& json, Colour colour, int alpha) {
  json.begin_object().key("rgba").begin_array();
  for (const int c : colour) json.value(c);
  json.value(alpha).end_array().end_object();
}

class Document {
 public:
  explicit Document(const RunProducts& run) : run_(run) { json_.begin_array(); }

  std::string take() {
    json_.end_array();
    return json_.take() + "\n";
  }
  std::string interval(SimTime from, SimTime to) const {
    return run_.utc(from) + "/" + run_.utc(to);
  }

  void head(SimTime from, SimTime to) {
    json_.begin_object().field("id", "document").field("name", "DMISE run " + run_.digest);
    json_.field("version", "1.0").key("clock").begin_object();
    json_.field("interval", interval(from, to)).field("currentTime", run_.utc(from));
    json_.field("multiplier", 10)
        .field("range", "LOOP_STOP")
        .field("step", "SYSTEM_CLOCK_MULTIPLIER");
    json_.end_object().end_object();
  }

  /// A packet with a name, in view while it has states.
  void begin(const std::string& id, const std::string& name) {
    json_.begin_object().field("id", id).field("name", name);
  }
  void end() { json_.end_object(); }

  /// Passes: states without longer gaps than `longest_gap_s`, a second longer at both ends.
  void availability(const std::vector<EphemerisState>& states) {
    std::vector<std::pair<SimTime, SimTime>> spans;
    for (const EphemerisState& s : states) {
      if (spans.empty() || (s.time - spans.back().second).seconds() > longest_gap_s)
        spans.emplace_back(s.time, s.time);
      spans.back().second = s.time;
    }
    json_.key("availability").begin_array();
    for (const auto& [from, to] : spans)
      json_.value(interval(from - sim_seconds(1.0), to + sim_seconds(1.0)));
    json_.end_array();
  }

  void inertial_position(const std::vector<EphemerisState>& states) {
    json_.key("position").begin_object();
    json_.field("interpolationAlgorithm", "HERMITE").field("interpolationDegree", 3);
    json_.field("referenceFrame", "INERTIAL").field("epoch", run_.utc({0}));
    json_.field("forwardExtrapolationType", "EXTRAPOLATE");
    json_.field("backwardExtrapolationType", "EXTRAPOLATE");
    json_.key("cartesianVelocity").begin_array();
    for (const EphemerisState& s : states) {
      json_.value(s.time.seconds());
      for (const double v : {s.position_m.x, s.position_m.y, s.position_m.z, s.velocity_m_per_s.x,
                             s.velocity_m_per_s.y, s.velocity_m_per_s.z})
        json_.value(v);
    }
    json_.end_array().end_object();
  }

  void point(Colour colour, int size, const std::string& text) {
    json_.key("point").begin_object().key("color");
    write_colour(json_, colour, 255);
    json_.field("pixelSize", size).end_object();
    json_.key("label").begin_object().field("text", text).field("font", "11px sans-serif");
    json_.key("fillColor");
    write_colour(json_, colour, 255);
    json_.key("pixelOffset").begin_object().key("cartesian2").begin_array();
    json_.value(8).value(-8).end_array().end_object().end_object();
  }

  void path(Colour colour, double seconds) {
    json_.key("path").begin_object().field("leadTime", 0.0).field("trailTime", seconds);
    json_.field("width", 1).key("material").begin_object().key("solidColor").begin_object();
    json_.key("color");
    write_colour(json_, colour, 160);
    json_.end_object().end_object().end_object();
  }

  void object(const std::string& id, const std::string& name,
              const std::vector<EphemerisState>& states, Colour colour) {
    begin(id, name);
    availability(states);
    inertial_position(states);
    point(colour, 6, name);
    path(colour, 600.0);
    end();
  }

  void sensor(const RunSensor& sensor, const std::vector<EphemerisState>& states) {
    constexpr Colour colour{240, 228, 66};
    begin("sensor/" + sensor.name, sensor.name);
    if (sensor.site) {
      json_.key("position").begin_object().field("referenceFrame", "FIXED");
      json_.key("cartographicDegrees").begin_array().value(sensor.site->longitude_deg);
      json_.value(sensor.site->latitude_deg).value(sensor.site->height_m).end_array().end_object();
    } else {
      inertial_position(states);
    }
    point(colour, 10, sensor.name);
    end();
  }

  /// Edges of a frame's field of view, as long as its exposure and what follows until `until`.
  void field(const RunFrame& frame, const RunSensor& sensor, SimTime until) {
    constexpr Colour colour{86, 180, 233};
    const std::string id = "field/" + sensor.name + "/" + std::to_string(frame.frame);
    const double right = sensor.columns - 0.5, bottom = sensor.rows - 0.5;
    const PixelPosition corners[] = {{-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}};
    std::vector<std::string> ends;
    for (const PixelPosition corner : corners) {
      if (!wcs_sees_sky(*frame.wcs, corner)) return;  // it sees the horizon all around
      const Vec<Gcrs> at =
          frame.sensor_position_m + wcs_direction(*frame.wcs, corner) * field_length_m;
      const std::string end = id + "/" + std::to_string(ends.size() + 1);
      // A point that moves with the sensor.
      begin(end, "");
      json_.field("availability", interval(frame.start, until));
      const Vec<Gcrs>& velocity = frame.sensor_velocity_m_per_s;
      std::vector<EphemerisState> states;
      for (const SimTime t : {frame.start, frame.middle, until})
        if (states.empty() || states.back().time < t)
          states.push_back({t, at + velocity * (t - frame.middle).seconds(), velocity});
      inertial_position(states);
      this->end();
      ends.push_back(end);
    }
    const std::string eye = "sensor/" + sensor.name;
    begin(id, sensor.name + ", frame " + std::to_string(frame.frame));
    json_.field("availability", interval(frame.start, until)).key("polyline").begin_object();
    json_.key("positions").begin_object().key("references").begin_array();
    // All edges in one line, those at the eye twice.
    for (const int k : {-1, 0, 1, -1, 2, 1, -1, 2, 3, -1, 3, 0})
      json_.value(reference(k < 0 ? eye : ends[std::size_t(k)]));
    json_.end_array().end_object().field("arcType", "NONE").field("width", 1);
    json_.key("material").begin_object().key("solidColor").begin_object().key("color");
    write_colour(json_, colour, 200);
    json_.end_object().end_object().end_object();
    end();
  }

 private:
  /// "ID#position", with what separates in such a text escaped by backslashes.
  static std::string reference(const std::string& id) {
    std::string out;
    for (const char c : id) {
      if (c == '\\' || c == '#' || c == '.') out += '\\';
      out += c;
    }
    return out + "#position";
  }

  const RunProducts& run_;
  JsonWriter json_;
};

void write_truth(const RunProducts& run, Document& document) {
  for (const ObjectEphemeris& o : truth_ephemerides(run))
    document.object("object/" + o.id, o.name.empty() ? o.id : o.name, o.states, {0, 201, 143});
}

void write_tracks(const RunProducts& run, Document& document) {
  for (const auto& [id, o] : track_ephemerides(run))
    document.object("track/" + std::to_string(id), o.name, o.states, {230, 159, 0});
}

}  // namespace

std::string czml_text(const ExportRequest& request) {
  const RunProducts& run = request.run;
  Document document(run);
  SimTime from{0}, to{1'000'000'000};
  std::map<std::string, std::vector<const RunFrame*>> frames;
  for (const RunFrame& f : run.frames) {
    to = std::max(to, f.end);
    frames[f.sensor].push_back(&f);
  }
  for (const Track& t : run.tracks) to = std::max(to, t.time);
  document.head(from, to);
  for (const RunSensor& sensor : run.sensors) {
    const auto& own = frames[sensor.name];
    std::vector<EphemerisState> states;
    for (const RunFrame* f : own)
      states.push_back({f->middle, f->sensor_position_m, f->sensor_velocity_m_per_s});
    if (!sensor.site && states.empty()) continue;
    document.sensor(sensor, states);
    const std::size_t every = own.size() / max_fields + 1;
    for (std::size_t k = 0; k < own.size(); k += every)
      if (own[k]->wcs)
        document.field(*own[k], sensor,
                       k + every < own.size() ? own[k + every]->start : own[k]->end);
  }
  if (request.kind == ProductKind::tracks)
    write_tracks(run, document);
  else
    write_truth(run, document);
  return document.take();
}

}  // namespace dmise
