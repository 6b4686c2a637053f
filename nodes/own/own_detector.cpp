#include "nodes/own/own_detector.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <span>

#include "core/image/fits_file.h"

namespace dmise {
namespace {

static_assert(std::endian::native == std::endian::little);

const OwnNode& detecting_node(const Scenario& scenario, const SensorConfig& sensor) {
  return *std::ranges::find(scenario.own_nodes, sensor.detector->node, &OwnNode::name);
}

MeasuredPlace place_of(const v1::OwnNodePlace& place) {
  return {{place.x_px(), place.y_px()}, {place.var_x_px2(), place.cov_xy_px2(), place.var_y_px2()}};
}

std::vector<MeasuredSource> sources_of(const v1::OwnNodeFound& found) {
  std::vector<MeasuredSource> sources;
  for (const v1::OwnNodeSource& one : found.sources()) {
    MeasuredSource& source = sources.emplace_back();
    source.centroid = place_of(one.centroid());
    source.light_e = one.flux_e();
    source.snr = one.snr();
    if (one.has_end1() != one.has_end2())
      throw Error("found[" + std::to_string(sources.size() - 1) +
                  "]: a streak has end1 and end2, got one of them");
    if (one.has_end1()) source.ends = {place_of(one.end1()), place_of(one.end2())};
  }
  return sources;
}

}  // namespace

OwnDetector::OwnDetector(const Scenario& scenario, const SensorConfig& sensor,
                         OwnNodeSettings settings)
    : scenario_(scenario),
      node_(detecting_node(scenario, sensor)),
      sensor_(sensor.name),
      settings_(std::move(settings)),
      restarts_(scenario.network, node_.name, settings_) {}

std::optional<std::vector<MeasuredSource>> OwnDetector::find(const CountImage& counts,
                                                             const FrameHeader& header) {
  const v1::OwnNodeFrame frame = frame_of(counts, header);
  const std::string place =
      "frame " + std::to_string(frame.frame()) + " (tick " + std::to_string(frame.tick()) + ")";
  while (true) {
    try {
      return ask(frame, counts);
    } catch (const ProgramLost& lost) {
      program_.reset();
      restarts_.after(lost, place);
    } catch (const Error& error) {
      throw Error(settings_.error_prefix + place + ": " + error.what());
    }
  }
}

std::optional<std::vector<MeasuredSource>> OwnDetector::ask(const v1::OwnNodeFrame& frame,
                                                            const CountImage& counts) {
  if (!program_) {
    v1::OwnNodeBegin begin = begin_of(scenario_, node_);
    begin.set_sensor(sensor_);
    program_.emplace(program_settings(scenario_, node_, settings_), std::move(begin),
                     restarts_.any());
  }
  const auto bytes = std::as_bytes(std::span(counts.pixels));
  const auto found =
      program_->find(frame, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (!found) return std::nullopt;
  auto sources = sources_of(*found);
  check_sources(sources, counts.columns, counts.rows);
  return sources;
}

v1::OwnNodeFrame OwnDetector::frame_of(const CountImage& counts, const FrameHeader& header) const {
  v1::OwnNodeFrame frame;
  frame.set_sensor(sensor_);
  frame.set_frame(header.frame);
  const Tick tick = (header.end.ns + scenario_.tick.ns - 1) / scenario_.tick.ns;
  frame.set_tick(std::clamp<Tick>(tick, 0, scenario_.last_tick()));
  frame.set_columns(std::uint32_t(counts.columns));
  frame.set_rows(std::uint32_t(counts.rows));
  for (auto& card : frame_file_cards(counts, header)) frame.add_cards(std::move(card));
  return frame;
}

SourceFinder own_finder(const Scenario& scenario, const std::string& sensor,
                        const std::string& directory, OwnNodeSettings settings) {
  const SensorConfig& config = sensor_named(scenario, sensor);
  if (!config.detector) return {};
  const std::string& node = config.detector->node;
  settings.log_path = directory + "/logs/" + node + "-" + sensor + ".log";
  settings.error_prefix += node + ": ";
  return [detector = std::make_shared<OwnDetector>(scenario, config, std::move(settings))](
             const CountImage& counts, const FrameHeader& header) {
    return detector->find(counts, header);
  };
}

}  // namespace dmise
