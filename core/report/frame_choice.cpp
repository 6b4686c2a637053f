#include "core/report/frame_choice.h"

#include <algorithm>

namespace dmise {

DrawnFrames choose_frames(const RunContents& run, const ReportSettings& settings) {
  DrawnFrames c;
  const std::size_t total = run.frames.size();
  c.every = std::max<std::size_t>(1, (total + settings.max_frames - 1) / settings.max_frames);
  const std::size_t sources = std::max(run.truths.size(), run.detections.size()) / c.every;
  c.source_every =
      std::max<std::size_t>(1, (sources + settings.max_sources - 1) / settings.max_sources);
  c.row_of.assign(total, 0);
  c.with_sources.assign(total, false);
  std::vector<std::size_t> seen(run.sensors.size()), kept(run.sensors.size());
  std::vector<std::vector<std::size_t>> able(run.sensors.size());  // rows with a file
  for (std::size_t f = 0; f < total; ++f) {
    const std::size_t sensor = run.frames[f].sensor;
    if (seen[sensor]++ % c.every != 0) continue;
    c.row_of[f] = c.frames.size();
    c.with_sources[f] = kept[sensor]++ % c.source_every == 0;
    if (c.with_sources[f] && !run.frames[f].fits.empty()) able[sensor].push_back(c.frames.size());
    c.frames.push_back(f);
  }
  // As many of each sensor, evenly over its time.
  std::size_t sensors = 0;
  double megapixels = 0.0;  // one frame of each sensor
  for (std::size_t s = 0; s < able.size(); ++s) {
    if (able[s].empty()) continue;
    const auto& camera = run.sensors[s].sensor;
    ++sensors;
    megapixels += camera.columns > 0 ? 1e-6 * camera.columns * camera.rows : 8.0;
  }
  const auto share = std::size_t(
      std::max(1.0, std::min(double(settings.max_views) / double(std::max<std::size_t>(1, sensors)),
                             settings.max_megapixels / std::max(1e-6, megapixels))));
  for (const auto& rows : able) {
    const std::size_t wanted = std::min(share, rows.size());
    for (std::size_t k = 0; k < wanted && c.viewed.size() < settings.max_views; ++k)
      c.viewed.push_back(rows[k * rows.size() / wanted]);
  }
  std::ranges::sort(c.viewed);
  return c;
}

}  // namespace dmise
