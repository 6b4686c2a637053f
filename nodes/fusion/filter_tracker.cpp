#include "nodes/fusion/filter_tracker.h"

#include <algorithm>

#include "core/base/units.h"
#include "core/optics/projection.h"

namespace dmise {
namespace {

constexpr double axis_slack_rad = 0.01;  // the boresight of a report is that of the stars

std::vector<MeanElements> elements_of(const ObjectRoster& known) {
  std::vector<MeanElements> out = known.elements;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].catalogue_number = known.objects[i].catalogue_number;
    out[i].name = known.objects[i].name;
  }
  return out;
}

}  // namespace

FilterTracker::FilterTracker(const Scenario& scenario, const ObjectRoster& known,
                             const Clock& clock)
    : tick_length_(scenario.tick),
      pointing_sigma_rad_(scenario.fusion->settings.pointing_sigma_arcsec * arcsec),
      fusion_(elements_of(known), clock, SimTime{scenario.duration.ns / 2},
              scenario.fusion->settings) {
  for (const SensorConfig& sensor : scenario.sensors) {
    if (!sensor.detect) continue;
    if (const auto& observing = sensor.observing) {
      cameras_[sensor.name] = {0, 0, observing->half_angle_deg * deg};
      continue;
    }
    const Optics& optics = sensor.camera.optics;
    cameras_[sensor.name] = {optics.columns, optics.rows,
                             std::min(half_diagonal_rad(optics) + axis_slack_rad, pi)};
  }
}

std::optional<Tracker::Tracked> FilterTracker::step(Tick tick,
                                                    std::span<const SearchedFrame> frames) {
  std::vector<SensorFrame> all;
  for (const auto& [report, found] : frames) {
    const Camera& camera = cameras_.at(report->sensor);
    all.push_back(sensor_frame(*report, found->detections, camera.columns, camera.rows,
                               camera.half_angle_rad, pointing_sigma_rad_));
  }
  return Tracked{.tracks = fusion_.step({tick * tick_length_.ns}, std::move(all))};
}

}  // namespace dmise
