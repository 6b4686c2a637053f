#include "core/detection/detect_file.h"

#include "core/base/error.h"
#include "core/detection/detection_json.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"

namespace dmise {

namespace {

/// UTC text of a row that is exposed later than the first; empty where the header has no time that
/// is whole microseconds before.
std::string utc_of_row(const FrameHeader& header, SimTime time) {
  if (!header.detector || !(header.detector->row_time_us > 0.0)) return "";
  const std::pair<SimTime, const std::string&> known[] = {{header.middle, header.middle_utc},
                                                          {header.start, header.start_utc},
                                                          {header.end, header.end_utc}};
  for (const auto& [base, text] : known)
    if (time > base && (time - base).ns % 1000 == 0 && !text.empty())
      return format_utc(Clock(parse_utc(text)).utc(time - base), 6);
  return "";
}

}  // namespace

std::string utc_in_frame(const FrameHeader& header, SimTime time) {
  const std::string& text = time == header.middle  ? header.middle_utc
                            : time == header.start ? header.start_utc
                                                   : header.end_utc;
  if (time != header.start && time != header.middle && time != header.end) {
    const std::string of_row = utc_of_row(header, time);
    if (of_row.empty())
      throw Error("not a time of this exposure: " + std::to_string(time.ns) + " ns");
    return of_row;
  }
  return text.ends_with('Z') || text.empty() ? text : text + "Z";
}

FileDetections as_lines(DetectionResult result, const FrameHeader& header,
                        const FrameNotes& notes) {
  FileDetections out{.result = std::move(result)};
  out.result.report.notes = notes;
  const UtcText utc = [&](SimTime time) { return utc_in_frame(header, time); };
  for (const Detection& d : out.result.detections)
    out.lines.push_back(to_json(d, utc, header.unknown));
  out.report = to_json(out.result.report, utc, header.unknown);
  return out;
}

DetectorSettings settings_for(const Frame& frame, const DetectorSettings& settings) {
  DetectorSettings with_mask = settings;
  if (!frame.unusable.pixels.empty()) with_mask.unusable = &frame.unusable;
  return with_mask;
}

FileDetections detect_frame(const Frame& frame, const DetectorSettings& settings, Threads& threads,
                            const CatalogueSky* sky) {
  return as_lines(detect(frame.counts, frame.header, settings_for(frame, settings), threads, sky),
                  frame.header, frame.notes);
}

FileDetections detect_file(const std::string& path, const DetectorSettings& settings,
                           Threads& threads, const CatalogueSky* sky) {
  return detect_frame(read_frame(path), settings, threads, sky);
}

}  // namespace dmise
