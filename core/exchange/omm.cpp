#include "core/exchange/omm.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/exchange/export_format.h"
#include "core/exchange/number_text.h"
#include "core/orbit/elements/element_text.h"
#include "core/orbit/elements/epoch.h"
#include "core/tracking/mean_elements_fit.h"

namespace dmise {
namespace {

constexpr double rev_per_day = 1440.0 / (2.0 * pi);  // in one rad/min

std::string element(const char* tag, const std::string& value) {
  std::string text = std::string("<") + tag + ">";
  for (const char c : value) {
    if (c == '&')
      text += "&amp;";
    else if (c == '<')
      text += "&lt;";
    else if (c == '>')
      text += "&gt;";
    else
      text += static_cast<unsigned char>(c) < ' ' ? '?' : c;
  }
  return text + "</" + tag + ">\n";
}

/// 14 significant digits: what a source of eight decimals says survives radians.
std::string element(const char* tag, double value) {
  if (!std::isfinite(value)) throw Error(std::string("export: ") + tag + " is not finite");
  return element(tag, formatted("%.14g", value));
}

std::string message(const RunProducts& run, const MeanElements& e,
                    const std::string& comment = "") {
  std::string id = omm_designator(e.designator);
  if (id.empty()) id = "UNKNOWN";
  const std::string name = e.name.empty() ? std::to_string(e.catalogue_number) : e.name;
  return "<omm id=\"CCSDS_OMM_VERS\" version=\"2.0\">\n<header>\n" +
         (comment.empty() ? comment : element("COMMENT", comment)) +
         element("CREATION_DATE", run.utc({0})) + element("ORIGINATOR", std::string("DMISE")) +
         "</header>\n<body>\n<segment>\n<metadata>\n" + element("OBJECT_NAME", name) +
         element("OBJECT_ID", id) + element("CENTER_NAME", std::string("EARTH")) +
         element("REF_FRAME", std::string("TEME")) + element("TIME_SYSTEM", std::string("UTC")) +
         element("MEAN_ELEMENT_THEORY", std::string("SGP4")) +
         "</metadata>\n<data>\n<meanElements>\n" +
         element("EPOCH", format_iso_epoch({e.epoch_jd1, e.epoch_jd2}, 6)) +
         element("MEAN_MOTION", e.mean_motion_rad_per_min * rev_per_day) +
         element("ECCENTRICITY", e.eccentricity) + element("INCLINATION", e.inclination_rad / deg) +
         element("RA_OF_ASC_NODE", e.raan_rad / deg) +
         element("ARG_OF_PERICENTER", e.argument_of_perigee_rad / deg) +
         element("MEAN_ANOMALY", e.mean_anomaly_rad / deg) + "</meanElements>\n<tleParameters>\n" +
         element("EPHEMERIS_TYPE", std::to_string(e.ephemeris_type)) +
         element("CLASSIFICATION_TYPE", std::string(1, e.classification)) +
         element("NORAD_CAT_ID", std::to_string(e.catalogue_number)) +
         element("ELEMENT_SET_NO", std::to_string(e.element_number)) +
         element("REV_AT_EPOCH", std::to_string(e.revolution)) +
         element("BSTAR", e.bstar_per_earth_radius) +
         element("MEAN_MOTION_DOT", e.mean_motion_dot_rad_per_min2 * (rev_per_day * 1440.0)) +
         element("MEAN_MOTION_DDOT",
                 e.mean_motion_ddot_rad_per_min3 * (rev_per_day * 1440.0 * 1440.0)) +
         "</tleParameters>\n</data>\n</segment>\n</body>\n</omm>\n";
}

/// The latest state of each confirmed track.
std::string messages_of_tracks(const RunProducts& run) {
  std::string text, why;
  for (const auto& [id, track] : run.confirmed_tracks()) {
    const OrbitState state{track->time, track->position_m, track->velocity_m_per_s,
                           track->drag_m2_per_kg, track->srp_m2_per_kg};
    auto fit = fit_mean_elements(run.clock, ForceModel(run.clock, track->time), state);
    if (!fit) {
      why = track_name(*track) + ": " + std::string(fit.reason);
      text += "<!-- " + why + " -->\n";
      continue;
    }
    MeanElements& e = fit->elements;
    e.catalogue_number = track->catalogue_number;
    e.name = track->name.empty() ? track_name(*track) : track->name;
    text += message(run, e,
                    track_name(*track) +
                        ": elements fitted to its orbit over one revolution; their path is " +
                        fixed_text(fit->rms_m, 0) + " m rms from it, at worst " +
                        fixed_text(fit->worst_m, 0) + " m");
  }
  if (text.find("<omm") == text.npos)
    throw ConfigError(run.directory +
                      "/tracks.jsonl: has nothing to export: an OMM needs a confirmed track" +
                      (why.empty() ? why : " with elements; " + why));
  return text;
}

constexpr const char* head = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<ndm>\n";

}  // namespace

std::string omm_text(const ExportRequest& request) {
  if (request.kind == ProductKind::tracks)
    return head + messages_of_tracks(request.run) + "</ndm>\n";
  if (request.elements.empty())
    throw ConfigError(request.run.directory +
                      "/run.json: no object of the scenario has an element set: an OMM needs one");
  std::string text = head;
  for (const MeanElements& e : request.elements) text += message(request.run, e);
  return text + "</ndm>\n";
}

}  // namespace dmise
