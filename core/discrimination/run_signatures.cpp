#include "core/discrimination/run_signatures.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/error.h"
#include "core/discrimination/aperture_fraction.h"
#include "core/image/fits_file.h"
#include "core/products/frame_file.h"
#include "core/products/product_json.h"
#include "core/run/run_files.h"
#include "core/run/run_record.h"

namespace dmise {
namespace {

Optics optics_of(const JsonRecord& camera) {
  Optics optics{.focal_length_m = camera.number("focal_length_m"),
                .aperture_m = camera.number("aperture_m"),
                .obscuration = camera.number("obscuration"),
                .pixel_pitch_m = camera.number("pixel_pitch_m"),
                .columns = camera.get<int>("columns"),
                .rows = camera.get<int>("rows"),
                .psf_fwhm_px = camera.number("psf_fwhm_px")};
  // Not the same everywhere, or always.
  if (camera.has("psf_field") || camera.has("focus_drift")) optics.spread.wavefront.emplace_back();
  if (!camera.has("spread")) return optics;
  const JsonRecord spread = camera.object("spread");
  PointSpread& s = optics.spread;
  s.model = PointSpread::Model(spread.get<int>("model"));
  s.spiders = spread.get<int>("spiders");
  s.support_px = spread.get<int>("support_px");
  s.oversampling = spread.get<int>("oversampling");
  s.defocus_m = spread.number("defocus_m");
  s.jitter_rad = spread.number("jitter_rad");
  s.field = {spread.number("coma_m"), spread.number("astigmatism_m"), spread.number("curvature_m")};
  if (spread.length("wavefront") > 0) s.wavefront.emplace_back();
  return optics;
}

Band band_of(const JsonRecord& camera) {
  Band band{.name = camera.get<std::string>("band"),
            .centre_m = camera.number("band_centre_m"),
            .width_m = camera.number("band_width_m")};
  if (camera.has("band_response")) {
    const JsonRecord curve = camera.object("band_response");
    band.response = {curve.number_list("wavelength_m"), curve.number_list("value")};
  }
  return band;
}

/// The places of one sensor's objects, by frame.
using Places = std::map<std::uint32_t, std::map<std::string, PixelPosition>>;

/// Why an object of a frame can't be measured; empty: it can.
std::string fault_of(const Truth& truth, const Aperture& aperture) {
  const double trail =
      std::hypot(truth.end_x_px - truth.start_x_px, truth.end_y_px - truth.start_y_px);
  if (!truth.whole) return "is not wholly in the frame";
  if (!(truth.rendered_signal_e > 0.0)) return "has no light";
  if (truth.resolved) return "is not a point";
  if (trail > aperture.radius_px) return "trails by more than the aperture's radius";
  return "";
}

class RunReader {
 public:
  RunReader(const std::string& directory, const Aperture& aperture)
      : directory_(directory), aperture_(aperture) {}

  void read_sensors(std::vector<std::string> wanted);
  void read_truth(const ReadProgress& progress);
  void measure(Threads& threads, const ReadProgress& progress);
  RunSpectra take();

 private:
  std::size_t sensor_index(const std::string& name) const;
  void measure_frame(std::size_t sensor, std::uint32_t frame, std::size_t slot);

  std::string directory_;
  Aperture aperture_;
  RunSpectra spectra_;
  std::vector<Places> places_;  // by sensor
  struct FrameOf {
    std::size_t sensor = 0;
    std::uint32_t frame = 0;
    std::map<std::string, BandMeasurement> measured;
    std::vector<std::string> left_out;
  };
  std::vector<FrameOf> frames_;
};

void RunReader::read_sensors(std::vector<std::string> wanted) {
  const RunRecord run = ended_run_record(directory_);
  for (const RunSensor& sensor : run.sensors) {
    const std::string& name = sensor.name;
    if (!sensor.camera_keys) continue;
    const auto at = std::find(wanted.begin(), wanted.end(), name);
    if (at == wanted.end() && !wanted.empty()) continue;
    if (at != wanted.end()) {
      wanted.erase(at);
      if (wanted.empty()) wanted.emplace_back();  // no further sensor
    }
    if (sensor.site)
      throw ConfigError(run.path + ": sensor " + name +
                        ": is on the ground: its air dims each band by an unknown amount");
    const JsonRecord& camera = *sensor.camera_keys;
    SpectralSensor s{.name = name, .band = band_of(camera)};
    try {
      s.aperture_fraction = aperture_fraction(optics_of(camera), s.band.centre_m, aperture_);
    } catch (const Error& e) {
      throw ConfigError(run.path + ": sensor " + name + ": " + e.what());
    }
    spectra_.sensors.push_back(std::move(s));
  }
  std::erase(wanted, "");
  if (!wanted.empty()) throw ConfigError(run.path + ": has no sensor " + wanted.front());
  if (spectra_.sensors.size() < 2)
    throw ConfigError(run.path + ": a signature needs two bands or more, got " +
                      std::to_string(spectra_.sensors.size()));
  std::stable_sort(spectra_.sensors.begin(), spectra_.sensors.end(),
                   [](const auto& a, const auto& b) { return a.band.centre_m < b.band.centre_m; });
}

std::size_t RunReader::sensor_index(const std::string& name) const {
  const auto& sensors = spectra_.sensors;
  return std::size_t(std::ranges::find(sensors, name, &SpectralSensor::name) - sensors.begin());
}

void RunReader::read_truth(const ReadProgress& progress) {
  places_.resize(spectra_.sensors.size());
  for_lines(existing_path(directory_, run_file::truth), progress, [&](const JsonRecord& record) {
    const Truth truth = truth_of(record);
    const std::size_t sensor = sensor_index(truth.sensor);
    if (sensor == places_.size() || !truth.in_frame) return;
    if (const std::string fault = fault_of(truth, aperture_); !fault.empty()) {
      spectra_.left_out.push_back(truth.sensor + "/" + std::to_string(truth.frame) + " " +
                                  truth.name + ": " + fault);
      return;
    }
    places_[sensor][truth.frame][truth.name] = {truth.rendered_x_px, truth.rendered_y_px};
  });
  for (std::size_t sensor = 0; sensor < places_.size(); ++sensor)
    for (const auto& [frame, objects] : places_[sensor])
      frames_.push_back({.sensor = sensor, .frame = frame});
}

void RunReader::measure_frame(std::size_t sensor, std::uint32_t number, std::size_t slot) {
  const SpectralSensor& s = spectra_.sensors[sensor];
  const Frame frame = read_frame(directory_ + "/" + s.name + "/" + frame_file_name(number));
  const FrameHeader& h = frame.header;
  const CountScale scale{h.gain_e_per_dn, h.bias_dn, h.saturation_dn};
  const double sunlight_e = full_sunlight_e(h.v_solar_zero_point_mag(), h.exposure_s);
  for (const auto& place : places_[sensor][number]) {
    const auto& object = place.first;  // clang 14 captures no structured binding
    const auto& at = place.second;
    const auto leave_out = [&](const std::string& why) {
      frames_[slot].left_out.push_back(s.name + "/" + std::to_string(number) + " " + object + ": " +
                                       why);
    };
    const double reach = aperture_.outer_px;
    if (at.x_px < reach || at.y_px < reach || at.x_px > frame.counts.columns - 1 - reach ||
        at.y_px > frame.counts.rows - 1 - reach) {
      leave_out("is too near to the frame's edge");
      continue;
    }
    BandMeasurement m{.centre = at, .flux = aperture_flux(frame.counts, scale, at, aperture_)};
    if (m.flux.saturated) {
      leave_out("is saturated");
      continue;
    }
    if (!(m.flux.sigma_e > 0.0)) {  // no weight among bands
      leave_out("has neither light nor noise");
      continue;
    }
    m.light = reflected({m.flux.flux_e, m.flux.sigma_e}, sunlight_e, s.aperture_fraction);
    frames_[slot].measured[object] = m;
  }
}

void RunReader::measure(Threads& threads, const ReadProgress& progress) {
  constexpr std::size_t at_once = 16;  // between two steps of progress
  for (std::size_t first = 0; first < frames_.size(); first += at_once) {
    const std::size_t count = std::min(at_once, frames_.size() - first);
    threads.for_ranges(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i)
        measure_frame(frames_[i].sensor, frames_[i].frame, i);
    });
    progress(double(first + count) / double(frames_.size()), "frames");
  }
}

RunSpectra RunReader::take() {
  std::map<std::pair<std::string, std::uint32_t>, std::vector<std::optional<BandMeasurement>>> all;
  for (const FrameOf& frame : frames_) {
    for (const auto& [object, measured] : frame.measured) {
      auto& bands = all[{object, frame.frame}];
      bands.resize(spectra_.sensors.size());
      bands[frame.sensor] = measured;
    }
    spectra_.left_out.insert(spectra_.left_out.end(), frame.left_out.begin(), frame.left_out.end());
  }
  for (const auto& [key, bands] : all) {
    SpectralSample sample{.object = key.first, .frame = key.second};
    for (const auto& band : bands)
      if (band) sample.bands.push_back(*band);
    if (sample.bands.size() == bands.size()) spectra_.samples.push_back(std::move(sample));
  }
  return std::move(spectra_);
}

}  // namespace

RunSpectra measure_run(const std::string& directory, std::vector<std::string> sensors,
                       const Aperture& aperture, Threads& threads, const ReadProgress& progress) {
  check(aperture);
  RunReader reader(directory, aperture);
  reader.read_sensors(std::move(sensors));
  reader.read_truth(progress);
  reader.measure(threads, progress);
  return reader.take();
}

std::vector<Measured> summed_light(const RunSpectra& spectra, const std::string& object) {
  std::vector<Measured> sums(spectra.sensors.size());
  for (const SpectralSample& sample : spectra.samples)
    if (sample.object == object)
      for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i].value += sample.bands[i].light.value;
        sums[i].sigma = std::hypot(sums[i].sigma, sample.bands[i].light.sigma);
      }
  return sums;
}

std::vector<std::string> objects_of(const RunSpectra& spectra) {
  std::vector<std::string> names;
  for (const SpectralSample& sample : spectra.samples)
    if (names.empty() || names.back() != sample.object) names.push_back(sample.object);
  return names;
}

}  // namespace dmise
