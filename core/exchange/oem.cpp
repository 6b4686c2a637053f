#include "core/exchange/oem.h"

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/exchange/export_format.h"
#include "core/exchange/kvn_text.h"
#include "core/orbit/oem_file.h"

namespace dmise {
namespace {

void write_covariances(const RunProducts& run, const ObjectEphemeris& object, KvnText& kvn) {
  bool any = false;
  for (const EphemerisState& state : object.states) {
    if (!state.covariance) continue;
    if (!any) kvn.line("COVARIANCE_START");
    any = true;
    kvn.key("EPOCH", run.utc(state.time)).key("COV_REF_FRAME", "GCRF");
    std::size_t next = 0;
    for (int row = 0; row < 6; ++row) {
      std::string line;
      for (int column = 0; column <= row; ++column)
        line +=
            formatted("%s%.15e", column > 0 ? " " : "", (*state.covariance)[next++] / (km * km));
      kvn.line(line);
    }
  }
  if (any) kvn.line("COVARIANCE_STOP");
}

void write(const RunProducts& run, const ObjectEphemeris& object, KvnText& kvn) {
  kvn.line("META_START").key("OBJECT_NAME", object.name).key("OBJECT_ID", object.id);
  kvn.key("CENTER_NAME", "EARTH").key("REF_FRAME", "GCRF").key("TIME_SYSTEM", "UTC");
  kvn.key("START_TIME", run.utc(object.states.front().time));
  kvn.key("STOP_TIME", run.utc(object.states.back().time)).line("META_STOP");
  for (const EphemerisState& s : object.states) {
    std::string line = oem_state_line(run.utc(s.time), s.position_m, s.velocity_m_per_s);
    line.pop_back();
    kvn.line(line);
  }
  write_covariances(run, object, kvn);
}

}  // namespace

std::string oem_text(const RunProducts& run, const std::vector<ObjectEphemeris>& ephemerides) {
  KvnText kvn(run, "CCSDS_OEM_VERS");
  for (const ObjectEphemeris& object : ephemerides)
    if (!object.states.empty()) write(run, object, kvn);
  return kvn.take();
}

std::vector<ObjectEphemeris> truth_ephemerides(const RunProducts& run) {
  std::map<std::pair<std::uint32_t, std::string>, std::map<SimTime, EphemerisState>> objects;
  for (const Truth& t : run.truths)
    if (t.true_position_m != Vec<Gcrs>{})
      objects[{t.catalogue_number, t.name}].try_emplace(
          t.middle, EphemerisState{t.middle, t.true_position_m, t.true_velocity_m_per_s});
  std::vector<ObjectEphemeris> ephemerides;
  for (const auto& [key, states] : objects) {
    const auto& [number, name] = key;
    ephemerides.push_back({name, number > 0 ? std::to_string(number) : name, {}});
    for (const auto& [time, state] : states) ephemerides.back().states.push_back(state);
  }
  return ephemerides;
}

std::map<std::uint32_t, ObjectEphemeris> track_ephemerides(const RunProducts& run) {
  std::map<std::uint32_t, ObjectEphemeris> objects;
  for (const Track& t : run.tracks) {
    if (t.status != TrackStatus::confirmed) continue;
    const std::string track = track_name(t);
    ObjectEphemeris& object = objects[t.id];
    object.name = t.name.empty() ? track : t.name;
    object.id = t.catalogue_number > 0 ? std::to_string(t.catalogue_number) : track;
    object.states.push_back({t.time, t.position_m, t.velocity_m_per_s, t.covariance});
  }
  return objects;
}

std::string run_oem_text(const ExportRequest& request) {
  const RunProducts& run = request.run;
  std::vector<ObjectEphemeris> ephemerides;
  if (request.kind == ProductKind::tracks) {
    for (auto& [id, object] : track_ephemerides(run)) ephemerides.push_back(std::move(object));
  } else {
    for (const Truth& t : run.truths) require_states(run, t);
    ephemerides = truth_ephemerides(run);
  }
  if (ephemerides.empty()) fail_empty(run, "an OEM", request.kind);
  return oem_text(run, ephemerides);
}

}  // namespace dmise
