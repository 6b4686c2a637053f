#include "core/detection/detection_lines.h"

#include <array>
#include <utility>

#include "core/base/error.h"
#include "core/products/product_json.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

/// The times of the exposure that have a text.
std::array<std::pair<SimTime, const std::string&>, 3> texts_of(const FrameHeader& header) {
  return {{{header.middle, header.middle_utc},
           {header.start, header.start_utc},
           {header.end, header.end_utc}}};
}

/// UTC text of a row that is exposed later than the first; empty where the header has no time that
/// is whole microseconds before.
std::string utc_of_row(const FrameHeader& header, SimTime time) {
  if (!header.detector || !(header.detector->row_time_us > 0.0)) return "";
  for (const auto& [base, text] : texts_of(header))
    if (time > base && (time - base).ns % 1000 == 0 && !text.empty())
      return format_utc(Clock(parse_utc(text)).utc(time - base), 6);
  return "";
}

}  // namespace

std::string utc_in_frame(const FrameHeader& header, SimTime time) {
  for (const auto& [known, text] : texts_of(header))
    if (time == known) return text.ends_with('Z') || text.empty() ? text : text + "Z";
  const std::string of_row = utc_of_row(header, time);
  if (of_row.empty())
    throw Error("not a time of this exposure: " + std::to_string(time.ns) + " ns");
  return of_row;
}

DetectionLines as_lines(DetectionResult result, const FrameHeader& header,
                        const FrameNotes& notes) {
  DetectionLines out{.result = std::move(result)};
  out.result.report.notes = notes;
  const UtcText utc = [&](SimTime time) { return utc_in_frame(header, time); };
  for (const Detection& d : out.result.detections)
    out.lines.push_back(to_json(d, utc, header.unknown));
  out.report = to_json(out.result.report, utc, header.unknown);
  return out;
}

}  // namespace dmise
