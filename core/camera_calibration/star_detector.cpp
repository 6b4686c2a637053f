#include "core/camera_calibration/star_detector.h"

#include <algorithm>
#include <cmath>

#include "core/camera_calibration/detector/pixel_corrections.h"

namespace dmise {
namespace {

StarPixels pixels_as_read(const Frame& frame) {
  const FrameHeader& h = frame.header;
  StarPixels out{.columns = frame.counts.columns, .rows = frame.counts.rows};
  out.saturation_e = 0.98 * (h.saturation_dn - h.bias_dn) * h.gain_e_per_dn;
  for (std::size_t i = 0; i < frame.counts.pixels.size(); ++i) {
    const bool use = frame.unusable.pixels.empty() || !frame.unusable.pixels[i];
    out.light_e.push_back(
        use ? float((double(frame.counts.pixels[i]) - h.bias_dn) * h.gain_e_per_dn)
            : std::nanf(""));
  }
  return out;
}

}  // namespace

StarDetector::StarDetector(const CalibrationSet& set, const DetectorCalibration& detector)
    : set_(set), d_(detector) {
  std::vector<double> radius_px, relative;
  for (const FieldLight& light : d_.response.field) {
    radius_px.push_back(light.radius_px);
    relative.push_back(std::clamp(light.relative.value, 0.01, 1.0));
  }
  if (radius_px.size() > 1) illumination_ = MonotoneCubic(radius_px, relative);
}

void StarDetector::set_facts(Frame& frame) const {
  FrameHeader& h = frame.header;
  if (d_.transfer.gain_e_per_dn) {
    h.gain_e_per_dn = d_.transfer.gain_e_per_dn->value / set_.step() * frame.count_step;
    h.unknown.remove(FrameFact::gain);
    if (d_.bias && d_.bias->frames > 1)
      h.read_noise_e = d_.bias->read_noise.value * d_.transfer.gain_e_per_dn->value;
  }
  if (!illumination_.empty()) {
    h.illumination = illumination_;
    h.illumination_radius = FieldRadius::distance_px;
  }
  if (d_.bias) {
    const double bias_dn = d_.bias->level.value * set_.step() + set_.zero();
    h.bias_dn = (bias_dn - frame.count_zero) / frame.count_step;
    h.unknown.remove(FrameFact::bias);
  }
}

StarPixels StarDetector::pixels(const CalibrationFrame& from, const Frame& frame) const {
  const bool known = d_.bias && d_.transfer.gain_e_per_dn && !set_.is_mosaic();
  return known ? corrected(from, frame) : pixels_as_read(frame);
}

double StarDetector::illumination(PixelPosition at) const {
  if (illumination_.empty()) return 1.0;
  return illumination_(
      std::hypot(at.x_px - 0.5 * (set_.columns() - 1), at.y_px - 0.5 * (set_.rows() - 1)));
}

StarPixels StarDetector::corrected(const CalibrationFrame& from, const Frame& frame) const {
  const double gain = d_.transfer.gain_e_per_dn->value;
  const double loss = d_.linearity.loss_per_dn ? d_.linearity.loss_per_dn->value : 0.0;
  const double memory_dn = frame.count_step / set_.step();
  const double range_dn = (frame.header.saturation_dn - frame.header.bias_dn) * memory_dn;
  std::vector<float> full{float(
      0.98 * (d_.saturation.level ? std::min(range_dn, d_.saturation.level->value) : range_dn))};
  straighten(loss, full);
  StarPixels out{.columns = set_.columns(),
                 .rows = set_.rows(),
                 .light_e = light_of(set_, from, d_.bias->mean),
                 .saturation_e = double(full[0]) * gain};
  uncouple(d_.coupling().value, set_.columns(), out.light_e);
  straighten(loss, out.light_e);
  const double time_s = from.exposure_s.value_or(0.0);
  const bool dark = d_.dark && d_.dark->rates.size() == out.light_e.size() && time_s > 0;
  if (dark) out.hot_e.assign(out.light_e.size(), 0.0F);
  for (std::size_t i = 0; i < out.light_e.size(); ++i) {
    const double rate = dark ? double(d_.dark->rates[i]) : 0.0;
    const double response = d_.response.pixels.empty() ? 1.0 : double(d_.response.pixels[i]);
    out.light_e[i] = float((double(out.light_e[i]) - rate * time_s) * gain / response);
    if (dark && rate - d_.dark->current.value > d_.dark->threshold)
      out.hot_e[i] = float((rate - d_.dark->current.value) * time_s * gain);
  }
  return out;
}

}  // namespace dmise
