#include "core/camera_calibration/detector/detector_calibration.h"

#include <algorithm>
#include <cmath>

#include "core/base/formatted.h"

namespace dmise {
namespace {

constexpr double effect_sigmas = 3.0, pattern_sigmas = 5.0;  // from which a value is given
constexpr double root_sigmas = 8.0;  // for roots: a variance's deviation is twice as large a share
constexpr double longest_stand_in_share = 0.1;  // for the bias, over the longest dark
constexpr std::array all_kinds{FrameKind::bias, FrameKind::dark, FrameKind::flat, FrameKind::light};

/// One frame has a level, and the noise from pixel to pixel.
BiasMeasurement single_bias(const CalibrationSet& set, const CalibrationFrame& frame) {
  BiasMeasurement out{.frames = 1, .exposure_s = frame.exposure_s.value_or(0.0)};
  out.mean.assign(std::size_t(set.columns()) * std::size_t(set.rows()), float(frame.level));
  out.level = {frame.level, frame.noise};
  out.floor_variance = frame.noise * frame.noise;
  return out;
}

std::optional<BiasMeasurement> bias_of(const CalibrationSet& set, DetectorCalibration& out) {
  const auto& biases = set.of(FrameKind::bias);
  if (biases.size() == 1) {
    out.notes.push_back("one bias frame: read noise takes two");
    return single_bias(set, biases[0]);
  }
  if (!biases.empty()) return measure_bias(set, biases, 0.0);
  std::vector<CalibrationFrame> shortest;
  const auto& darks = set.of(FrameKind::dark);
  for (const CalibrationFrame& dark : darks)
    if (dark.exposure_s && dark.exposure_s == darks.front().exposure_s) shortest.push_back(dark);
  if (shortest.size() < 2) {
    out.notes.push_back("no bias frames: bias, read noise and dark current are not measured");
    return std::nullopt;
  }
  const double stand_in_s = *shortest.front().exposure_s;
  out.notes.push_back(formatted("no bias frames: darks of %g s stand in for them", stand_in_s));
  if (stand_in_s > longest_stand_in_share * darks.back().exposure_s.value_or(0.0))
    out.notes.push_back(
        "the shortest darks have the noise of their dark current in what is given as read noise");
  return measure_bias(set, shortest, stand_in_s);
}

void note_bias(const BiasMeasurement& bias, std::vector<std::string>& notes) {
  if (bias.clipped)
    notes.push_back(
        "the bias is clipped at 0: its level and read noise are not those of the camera");
  if (bias.drift_dn > 0)
    notes.push_back(
        formatted("the bias's level wanders by %.2g DN rms from frame to frame", bias.drift_dn));
  constexpr double min_noise_dn = 0.4;
  if (bias.frames > 1 && bias.read_noise.value < min_noise_dn)
    notes.push_back(formatted("a read noise of %.2g DN is lost in whole counts: it is not reliable",
                              bias.read_noise.value));
}

void note_dark(const DarkMeasurement& dark, std::vector<std::string>& notes) {
  constexpr double max_spread_c = 1.0;
  if (dark.temperature_spread_c > max_spread_c)
    notes.push_back(formatted("darks differ by %.1f K: the dark current is that of their mean",
                              dark.temperature_spread_c));
  if (dark.drift > 0)
    notes.push_back(
        formatted("the level of darks wanders: their rates differ by %.2g DN/s rms", dark.drift));
}

void measure_dark_frames(const CalibrationSet& set, DetectorCalibration& out) {
  if (out.bias && !set.of(FrameKind::dark).empty()) {
    const double most = out.saturation.level ? out.saturation.level->value : 0.0;
    out.dark = measure_dark(set, set.of(FrameKind::dark), *out.bias, most, out.coupling().value);
    if (out.dark->frames == 0) out.dark.reset();
  }
  if (out.dark)
    note_dark(*out.dark, out.notes);
  else
    out.notes.push_back("no darks with an exposure: dark current and hot pixels are not measured");
}

/// The detector's response to light, with what flats show of its dark current taken off.
void measure_light_response(const CalibrationSet& set, const FlatTiles& flats,
                            DetectorCalibration& out) {
  const double loss = out.linearity.loss_per_dn ? out.linearity.loss_per_dn->value : 0.0;
  out.response = measure_response(set, flats, out.saturation, *out.bias,
                                  out.dark ? &*out.dark : nullptr, loss, out.coupling());
}

/// The tiles of the flats; empty if these show nothing.
FlatTiles measure_flat_frames(const CalibrationSet& set, Threads& threads,
                              DetectorCalibration& out) {
  const std::size_t count = set.of(FrameKind::flat).size();
  if (count == 0) {
    out.notes.push_back("no flats: gain, full well, linearity and response are not measured");
    return {};
  }
  if (!out.bias) {
    out.notes.push_back("flats without a bias's level: gain and response are not measured");
    return {};
  }
  const double floor = out.bias->floor_variance;
  FlatTiles flats = measure_flats(set, out.bias->mean, threads);
  const Tiles& tiles = set.tiles();
  out.saturation = find_saturation(flats, tiles, floor);
  for (std::size_t f = 0; f < count; ++f)
    if (!out.saturation.usable[f])
      out.notes.push_back(flats.flats[f]->name() +
                          ": is saturated, wholly or in part: tiles that "
                          "are full, and for response and linearity the frame, are left out");
  if (flats.pairs.empty())
    out.notes.push_back(
        "no two flats have the same exposure and light within 5 %: the gain is not measured");
  out.linearity = measure_linearity(flats, tiles, out.saturation, floor);
  out.transfer = measure_gain(flats, tiles, out.saturation, out.linearity, floor, set.is_mosaic());
  if (out.linearity.unsteady > 0)
    out.notes.push_back(formatted("the light of flats is unsteady by %.2g %%%s",
                                  100 * out.linearity.unsteady,
                                  out.linearity.loss_per_dn ? "" : ": linearity is not measured"));
  constexpr double min_shortfall = 0.01;
  const double shortfall = out.transfer.shortfall_per_dn * out.transfer.highest_dn;
  if (std::abs(shortfall) > min_shortfall)
    out.notes.push_back(formatted(
        "the noise of flats is %.1f %% %s than a straight line at %.0f DN, as by charge that "
        "repels charge; the gain is that of faint light",
        100 * std::abs(shortfall), shortfall > 0 ? "less" : "more", out.transfer.highest_dn));
  return flats;
}

/// Writes quantities of the detector.
class DetectorQuantities {
 public:
  DetectorQuantities(CameraCalibration& camera, MeasuredValue gain)
      : camera_(camera), gain_(gain) {}

  void add(const std::string& key, const std::string& unit, MeasuredValue m, int frames,
           const std::string& how) {
    camera_.quantities.push_back(
        {"detector." + key, unit, m.value, m.sigma, frames, ValueOrigin::measured, how});
  }
  void add_default(const std::string& key, const std::string& unit, double value,
                   const std::string& how, ValueOrigin origin = ValueOrigin::assumed) {
    camera_.quantities.push_back({"detector." + key, unit, value, std::nullopt, 0, origin, how});
  }
  /// A value in DN that the file has in electrons.
  void add_in_e(const std::string& key, const std::string& unit, MeasuredValue dn, int frames,
                const std::string& how) {
    add(key, unit, in_e(dn), frames, how);
  }
  /// Leaves the last one out of the file if it is below some deviations.
  void keep_if_significant(double sigmas) {
    CameraQuantity& last = camera_.quantities.back();
    if (!(last.value > sigmas * last.sigma.value_or(0.0))) last.origin = ValueOrigin::insignificant;
  }
  MeasuredValue in_e(MeasuredValue dn) const {
    return {dn.value * gain_.value, std::hypot(dn.sigma * gain_.value, dn.value * gain_.sigma)};
  }

 private:
  CameraCalibration& camera_;
  MeasuredValue gain_;
};

void add_bias(const BiasMeasurement& bias, DetectorQuantities& to) {
  const auto stand_in = bias.exposure_s > 0 ? formatted("darks of %g s", bias.exposure_s)
                                            : std::string("bias frames");
  to.add("bias_dn", "DN", bias.level, bias.frames, "mean of " + stand_in);
  if (bias.frames < 2) {
    to.add_default("read_noise_e", "e-", to.in_e(bias.level).sigma, "noise from pixel to pixel");
    return;
  }
  to.add_in_e("read_noise_e", "e-", bias.read_noise, bias.frames, "scatter of " + stand_in);
  if (bias.frames >= 4) {
    to.add("read_noise_spread", "", bias.read_noise_spread, bias.frames, "pixels differ");
    to.keep_if_significant(root_sigmas);
  }
  to.add_in_e("column_noise_e", "e-", bias.column_noise, bias.frames, "columns of " + stand_in);
  to.keep_if_significant(root_sigmas);
  to.add_in_e("pixel_offset_e", "e-", bias.pixel_offset, bias.frames, "pattern of " + stand_in);
  to.keep_if_significant(root_sigmas);
  to.add_in_e("column_offset_e", "e-", bias.column_offset, bias.frames, "pattern of " + stand_in);
  to.keep_if_significant(root_sigmas);
}

void add_dark(const DarkMeasurement& dark, DetectorQuantities& to) {
  to.add_in_e("dark_e_per_s", "e-/s", dark.current, dark.frames,
              formatted("darks of up to %g s", dark.longest_s));
  to.keep_if_significant(effect_sigmas);
  const double celsius = dark.temperature_c.value_or(0.0);
  to.add_default("dark_reference_c", "deg C", celsius,
                 dark.temperature_c ? "mean of the darks" : "no header states a temperature",
                 dark.temperature_c ? ValueOrigin::header : ValueOrigin::assumed);
  to.add_default("temperature_c", "deg C", celsius, "that of the darks",
                 dark.temperature_c ? ValueOrigin::header : ValueOrigin::assumed);
  if (!(dark.hot_rate.value > 0)) return;
  const std::string how = counted(dark.counted, "pixel") +
                          formatted(" beyond %.3g e-/s", to.in_e({dark.threshold, 0}).value);
  to.add("hot_pixel_fraction", "", dark.hot_fraction, dark.frames, how);
  to.add_in_e("hot_pixel_e_per_s", "e-/s", dark.hot_rate, dark.frames, how);
}

/// Bits of the converter: seen where pixels share the greatest number of so many bits.
struct AdcBits {
  int bits = 16;
  bool seen = false;
};
AdcBits adc_bits_of(const CalibrationSet& set) {
  constexpr std::size_t min_pixels = 5;
  double greatest = 0.0;
  std::size_t pixels = 0;
  for (const FrameKind kind : all_kinds)
    for (const CalibrationFrame& frame : set.of(kind)) {
      if (frame.greatest > greatest) greatest = frame.greatest, pixels = 0;
      if (frame.greatest == greatest) pixels += frame.greatest_pixels;
    }
  for (int bits = 8; bits <= 16; ++bits)
    if (greatest == std::exp2(bits) - 1 && pixels >= min_pixels) return {bits, true};
  for (int bits = 8; bits < 16; bits += 2)
    if (greatest < std::exp2(bits)) return {bits, false};
  return {};
}

/// Signal of a straight response [DN].
double straight_of(double signal, double loss) {
  return 2 * signal / (1 + std::sqrt(std::max(0.0, 1 - 4 * loss * signal)));
}

void add_full_well(const CalibrationSet& set, const DetectorCalibration& d,
                   DetectorQuantities& to) {
  const double loss = d.linearity.loss_per_dn ? d.linearity.loss_per_dn->value : 0.0;
  const AdcBits adc = adc_bits_of(set);
  const double bias = d.bias ? d.bias->level.value : 0.0;
  const double range = std::max(1.0, std::exp2(adc.bits) - 1 - bias);
  double full = straight_of(range, loss);
  const bool by_adc = d.saturation.level && d.saturation.level->value > range - 1.5;
  if (d.saturation.level && !by_adc) {
    const MeasuredValue level = *d.saturation.level;
    full = straight_of(level.value, loss);
    const double by_loss =
        d.linearity.loss_per_dn ? full * full * d.linearity.loss_per_dn->sigma : 0;
    to.add_in_e("full_well_e", "e-", {full, std::hypot(level.sigma * full / level.value, by_loss)},
                d.saturation.saturated, "level of flats that are full");
  } else {
    to.add_default("full_well_e", "e-", to.in_e({full, 0}).value,
                   by_adc ? "flats reach the converter's limit: at least"
                          : "no frame shows it: the converter's limit");
  }
  if (d.linearity.loss_per_dn) {
    const MeasuredValue a = *d.linearity.loss_per_dn;
    to.add("nonlinearity", "", {a.value * full, a.sigma * full}, d.linearity.frames,
           "ramp of flats, at full well");
    to.keep_if_significant(effect_sigmas);
  }
  to.add_default("adc_bits", "", adc.bits,
                 adc.seen ? "pixels at the greatest number" : "the greatest count needs so many",
                 adc.seen ? ValueOrigin::measured : ValueOrigin::assumed);
}

}  // namespace

MeasuredValue DetectorCalibration::coupling() const {
  return transfer.coupling.is_significant(pattern_sigmas) ? transfer.coupling : MeasuredValue{};
}

DetectorCalibration calibrate_detector(const CalibrationSet& set, Threads& threads) {
  DetectorCalibration out;
  out.bias = bias_of(set, out);
  if (out.bias) note_bias(*out.bias, out.notes);
  const FlatTiles flats = measure_flat_frames(set, threads, out);
  measure_dark_frames(set, out);
  if (!flats.flats.empty()) measure_light_response(set, flats, out);
  return out;
}

void add_detector(const CalibrationSet& set, const DetectorCalibration& d,
                  std::optional<double> quantum_efficiency, CameraCalibration& camera) {
  const PhotonTransfer& p = d.transfer;
  const auto& header_gain = set.facts().gain_e_per_dn;
  const MeasuredValue gain = p.gain_e_per_dn
                                 ? *p.gain_e_per_dn
                                 : MeasuredValue{header_gain.value_or(1.0) * set.step(), 0.0};
  DetectorQuantities to(camera, gain);
  to.add_default("quantum_efficiency", "", quantum_efficiency.value_or(1.0),
                 quantum_efficiency ? "" : "it is in transmission",
                 quantum_efficiency ? ValueOrigin::stated : ValueOrigin::assumed);
  if (p.gain_e_per_dn)
    to.add("gain_e_per_dn", "e-/DN", gain, p.frames,
           formatted("photon transfer, %.0f to %.0f DN", p.lowest_dn, p.highest_dn));
  else
    to.add_default("gain_e_per_dn", "e-/DN", gain.value,
                   header_gain ? "EGAIN" : "nothing tells it: electrons are counts",
                   header_gain ? ValueOrigin::header : ValueOrigin::assumed);
  if (d.bias)
    add_bias(*d.bias, to);
  else
    to.add_default("bias_dn", "DN", 0.0, "no bias frames");
  if (d.dark) add_dark(*d.dark, to);
  add_full_well(set, d, to);
  if (d.response.frames > 1) {
    to.add("prnu_rms", "", d.response.prnu, d.response.frames, "pattern of flats");
    to.keep_if_significant(effect_sigmas);
  }
  if (p.gain_e_per_dn && !set.is_mosaic()) {
    to.add("interpixel_coupling", "", p.coupling, p.frames, "noise that neighbours share");
    to.keep_if_significant(pattern_sigmas);
  }
  camera.notes.insert(camera.notes.end(), d.notes.begin(), d.notes.end());
}

}  // namespace dmise
