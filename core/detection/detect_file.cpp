#include "core/detection/detect_file.h"

#include "core/base/error.h"
#include "core/detection/detection_json.h"

namespace dmise {

std::string utc_in_frame(const FrameHeader& header, SimTime time) {
  const std::string& text = time == header.middle  ? header.middle_utc
                            : time == header.start ? header.start_utc
                                                   : header.end_utc;
  if (time != header.start && time != header.middle && time != header.end)
    throw Error("not a time of this exposure: " + std::to_string(time.ns) + " ns");
  return text.ends_with('Z') || text.empty() ? text : text + "Z";
}

FileDetections detect_frame(const Frame& frame, const DetectorSettings& settings,
                            Threads& threads) {
  DetectorSettings with_mask = settings;
  if (!frame.unusable.pixels.empty()) with_mask.unusable = &frame.unusable;
  FileDetections out{.result = detect(frame.counts, frame.header, with_mask, threads)};
  out.result.report.notes = frame.notes;
  const UtcText utc = [&](SimTime time) { return utc_in_frame(frame.header, time); };
  const UnknownFacts& unknown = frame.header.unknown;
  for (const Detection& d : out.result.detections) out.lines.push_back(to_json(d, utc, unknown));
  out.report = to_json(out.result.report, utc, unknown);
  return out;
}

FileDetections detect_file(const std::string& path, const DetectorSettings& settings,
                           Threads& threads) {
  return detect_frame(read_frame(path), settings, threads);
}

}  // namespace dmise
