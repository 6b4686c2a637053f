#include "sensors/frame/cost_lines.h"

#include <algorithm>
#include <cmath>

#include "core/base/files/json.h"
#include "core/config/sensors/effect_list.h"
#include "core/plan/plan_json.h"

namespace dmise {

std::uint32_t frames_of_cost_line(std::uint32_t frame) {
  std::uint64_t frames = 1;
  while (frame > frames_with_own_cost * frames) frames *= 2;
  return std::uint32_t(frames);
}

std::string CostLines::add(const FrameProducts& frame, double pss_mb) {
  Levels levels;
  for (const PlannedEffect& planned : frame.plan.planned)
    levels.emplace_back(planned.facts, planned.level);
  std::string lines;
  const bool as_before = levels == levels_;
  if (!as_before) lines = take();
  levels_ = std::move(levels);
  const auto effects = all_effects();
  effects_s_.resize(effects.size());
  for (std::size_t k = 0; k < effects.size(); ++k) effects_s_[k] += frame.times[*effects[k]];
  total_s_ += frame.total_s;
  detection_s_ += frame.detection_s;
  pss_mb_ = std::max(pss_mb_, pss_mb);
  sensor_ = frame.report.sensor;
  plan_ = frame.plan;
  last_frame_ = frame.report.frame;
  ++frames_;
  if (!as_before || last_frame_ % frames_of_cost_line(last_frame_) == 0) lines += take();
  return lines;
}

std::string CostLines::take() {
  if (frames_ == 0) return "";
  // Without the digits that no clock has: a long run has many lines.
  const auto mean_s = [this](double sum_s) { return std::round(sum_s / frames_ * 1e6) / 1e6; };
  JsonWriter cost;
  cost.begin_object().field("sensor", sensor_).field("frame", last_frame_);
  if (frames_ > 1) cost.field("frames", frames_);
  cost.field("total_s", mean_s(total_s_)).field("detection_s", mean_s(detection_s_));
  cost.field("pss_mb", pss_mb_).key("effects_s").begin_object();
  const auto effects = all_effects();
  for (std::size_t k = 0; k < effects.size(); ++k)
    if (const double s = mean_s(effects_s_[k]); s > 0.0) cost.field(effects[k]->name, s);
  cost.end_object();
  if (!plan_.planned.empty()) write_plan(cost.key("plan"), plan_);
  frames_ = 0;
  total_s_ = detection_s_ = pss_mb_ = 0.0;
  effects_s_.clear();
  return cost.end_object().take() + "\n";
}

}  // namespace dmise
