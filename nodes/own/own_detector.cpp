#include "nodes/own/own_detector.h"

#include <bit>
#include <memory>
#include <span>

#include "core/image/fits_file.h"

namespace dmise {
namespace {

static_assert(std::endian::native == std::endian::little);

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

v1::OwnNodeFrame frame_of(const CountImage& counts, const FrameHeader& header, Tick tick) {
  v1::OwnNodeFrame frame;
  frame.set_sensor(header.sensor);
  frame.set_frame(header.frame);
  frame.set_tick(tick);
  frame.set_columns(std::uint32_t(counts.columns));
  frame.set_rows(std::uint32_t(counts.rows));
  for (auto& card : frame_file_cards(counts, header)) frame.add_cards(std::move(card));
  return frame;
}

std::optional<std::vector<MeasuredSource>> find(OwnModel& program, const v1::OwnNodeFrame& frame,
                                                const CountImage& counts) {
  const auto bytes = std::as_bytes(std::span(counts.pixels));
  const auto found =
      program.find(frame, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (!found) return std::nullopt;
  auto sources = sources_of(*found);
  check_sources(sources, counts.columns, counts.rows);
  return sources;
}

}  // namespace

SourceFinder own_finder(const Scenario& scenario, const std::string& sensor,
                        const std::string& directory, OwnNodeSettings settings) {
  const SensorConfig& config = sensor_named(scenario, sensor);
  if (!config.detector) return {};
  const auto program =
      std::make_shared<FrameProgram>(scenario, config, directory, std::move(settings));
  return [program, sensor](const CountImage& counts, const FrameHeader& header) {
    const v1::OwnNodeFrame frame = frame_of(counts, header, program->tick_after(header.end));
    const auto beginning = [&] {
      FrameProgram::Beginning told{program->begin()};
      told.begin.set_sensor(sensor);
      return told;
    };
    return program->ask(header.frame, header.end, beginning,
                        [&](OwnModel& started) { return find(started, frame, counts); });
  };
}

}  // namespace dmise
