#include "core/sequences/sequence_lines.h"

#include <optional>

#include "core/base/files/json.h"
#include "core/base/units.h"
#include "core/detection/detection_lines.h"
#include "core/products/product_json.h"

namespace dmise {
namespace {

/// A number, or nothing if the pointing is unknown.
std::optional<double> pointed(const SequenceTrack& track, double value) {
  if (track.header.unknown.has(FrameFact::pointing)) return std::nullopt;
  return value;
}

void write_positions(JsonWriter& json, const SequenceTrack& track) {
  json.key("positions").begin_array();
  for (const SequencePosition& p : track.positions) {
    json.begin_object()
        .field("file", std::string_view(p.file))
        .field("frame", p.frame)
        .field("time_utc",
               std::string_view(p.time_utc.ends_with('Z') ? p.time_utc : p.time_utc + "Z"))
        .field("after_s", p.after_s)
        .field("x_px", p.x_px)
        .field("y_px", p.y_px)
        .list("covariance_px2", p.covariance_px2)
        .field("ra_deg", pointed(track, p.ra_rad / deg))
        .field("dec_deg", pointed(track, p.dec_rad / deg))
        .field("snr", p.snr)
        .field("measured", p.measured)
        .field("used", p.used)
        .end_object();
  }
  json.end_array();
}

std::string sequence_of(const SequenceTrack& track, std::uint32_t number) {
  JsonWriter json;
  json.begin_object()
      .field("track", number)
      .field("found_by", track.by_stack ? "stack" : "tracklet")
      .field("rate_ra_arcsec_per_s", pointed(track, track.rate_ra_rad_per_s / arcsec))
      .field("rate_dec_arcsec_per_s", pointed(track, track.rate_dec_rad_per_s / arcsec));
  json.key("covariance_arcsec");
  if (track.header.unknown.has(FrameFact::pointing)) {
    json.null();
  } else {
    json.begin_array();
    for (const double v : track.covariance) json.value(v / (arcsec * arcsec));
    json.end_array();
  }
  json.list("rate_px_per_s", {track.rate_px_per_s.x_px, track.rate_px_per_s.y_px});
  write_positions(json, track);
  return json.end_object().take();
}

}  // namespace

std::string to_json(const SequenceTrack& track, std::uint32_t number) {
  const UtcText utc = [&](SimTime time) { return utc_in_frame(track.header, time); };
  std::string line = to_json(track.detection, utc, track.header.unknown);
  line.pop_back();  // the brace that ends the object
  return line + ",\"sequence\":" + sequence_of(track, number) + "}";
}

}  // namespace dmise
