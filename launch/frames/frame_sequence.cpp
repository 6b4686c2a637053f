#include "launch/frames/frame_sequence.h"

#include <cstdio>
#include <utility>

#include "core/image/known_defects.h"
#include "core/sequences/detect_sequence.h"
#include "core/sequences/sequence_lines.h"
#include "launch/command/notes.h"
#include "launch/run/progress.h"

namespace dmise {

SequenceFrame frame_of_sequence(const std::string& path, const Frame& frame) {
  if (const auto calibrated = without_hot_pixels(frame))
    return {path, calibrated->counts, calibrated->header, calibrated->unusable};
  return {path, frame.counts, frame.header, frame.unusable};
}

void print_sequence(std::vector<SequenceFrame> frames, double max_rate_rad_per_s,
                    Threads& threads) {
  Progress progress;
  SequenceSearch search;
  if (max_rate_rad_per_s > 0) search.max_rate_rad_per_s = max_rate_rad_per_s;
  search.progress = [&](double share) { progress.show_share(share, "shifting and adding frames"); };
  const SequenceResult found = detect_sequence(std::move(frames), search, threads);
  progress.clear_line();
  for (const std::string& note : found.notes) print_note(note);
  for (std::size_t i = 0; i < found.tracks.size(); ++i)
    std::printf("%s\n", to_json(found.tracks[i], std::uint32_t(i + 1)).c_str());
}

}  // namespace dmise
