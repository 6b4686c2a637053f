#include "core/detection/detect_file.h"

#include "core/base/error.h"
#include "core/detection/detection_json.h"
#include "core/image/fits_file.h"

namespace dmise {

std::string utc_in_frame(const FrameHeader& header, SimTime time) {
  const std::string& text = time == header.middle  ? header.middle_utc
                            : time == header.start ? header.start_utc
                                                   : header.end_utc;
  if (time != header.start && time != header.middle && time != header.end)
    throw Error("not a time of this exposure: " + std::to_string(time.ns) + " ns");
  return text.ends_with('Z') ? text : text + "Z";
}

FileDetections detect_file(const std::string& path, const DetectorSettings& settings,
                           Threads& threads, const CatalogueSky* sky) {
  const Frame frame = read_frame(path);
  const auto result = detect(frame.counts, frame.header, settings, threads, sky);
  const UtcText utc = [&](SimTime time) { return utc_in_frame(frame.header, time); };
  FileDetections out;
  for (const Detection& d : result.detections) out.lines.push_back(to_json(d, utc));
  out.report = to_json(result.report, utc);
  return out;
}

}  // namespace dmise
