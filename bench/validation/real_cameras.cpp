#include "bench/validation/real_cameras.h"

#include <vector>

namespace dmise {
namespace {

// Zero point: the share of light that Gunn's curves of 2001 have in i, integral of dlambda / lambda
// 0.0591 behind 1.3 airmasses, over that of the curve in the program, 0.1519, and the air.
constexpr const char* sdss = R"(
simulation: {start: 2009-10-17T01:52:36.59Z, duration_s: 60, tick_s: 1}
sensors:
  - name: sdss
    site: {latitude_deg: 32.7803, longitude_deg: -105.8203, height_m: 2788}
    camera:
      optics: {columns: 2048, rows: 1489, pixel_pitch_m: 24e-6, focal_length_m: 12.5, aperture_m: 2.5, obscuration: 0.5}
      detector: {quantum_efficiency: 0.42, read_noise_e: 13.0, full_well_e: 300000, gain_e_per_dn: 4.64, bias_dn: 1000}
      band: sdss-i
      magnitude_system: AB
    pointing: {ra_deg: 325.54, dec_deg: 18.13, tracking: sidereal}
    exposure_s: 53.907
    cadence_s: 60
    sky: {preset: dark, solar_flux_sfu: 72}
    atmosphere: {extinction: kitt_peak}
)";
constexpr const char* about_sdss =
    "SDSS: 2.5 m, the pupil's obscuration 0.5 (technical note 19960410), 0.396 arcsec a pixel; the "
    "share of light in i "
    "behind 1.3 airmasses is Gunn's of June 2001; gain 4.64 e-/DN and dark variance 7.84 DN2 of "
    "camera column 5 are of the "
    "data model of `frame` files. The frame is in nanomaggies, less the sky: its zero point is "
    "that of `NMGY`, its sky what "
    "its noise asks for beside read-out. It was scanned: each row was exposed by 1489 rows of the "
    "detector in turn.";

// Throughput: 28.9 mag give 1 e-/s.
constexpr const char* hsc = R"(
simulation: {start: 2020-05-28T14:32:17.921Z, duration_s: 60, tick_s: 1}
sensors:
  - name: hsc
    site: {latitude_deg: 19.8255, longitude_deg: -155.4760, height_m: 4139}
    camera:
      optics: {columns: 2144, rows: 4241, pixel_pitch_m: 15e-6, focal_length_m: 18.2, aperture_m: 8.2}
      detector: {quantum_efficiency: 0.70, read_noise_e: 4.5, full_well_e: 150000, gain_e_per_dn: 3.21, bias_dn: 1000}
      band: sdss-r
      magnitude_system: AB
    pointing: {ra_deg: 3.3756, dec_deg: 2.8246, tracking: sidereal}
    exposure_s: 40
    cadence_s: 60
    sky: {preset: dark, solar_flux_sfu: 70}
    atmosphere: {extinction: mauna_kea}
)";
constexpr const char* about_hsc =
    "Hyper Suprime-Cam: 8.2 m, 15 um and 0.17 arcsec a pixel, read noise 4.5 e-, 28.9 mag give 1 "
    "e-/s through r2 (Subaru's "
    "pages of the instrument); `sdss-r` stands for r2, and the throughput follows from the 28.9 "
    "mag: the zero point is no "
    "prediction. The gain is `T_GAIN1`, since `GAIN` is 0. The frame is raw, neither flat nor "
    "calibrated, and states no bias: "
    "taken is the median of columns 2 to 8, before the light that `T_EFMN11` lets begin at 9.";

// Two mirrors of aluminium, filter and detector: 0.6 of the light, assumed.
constexpr const char* vatt = R"(
simulation: {start: 2021-12-12T12:51:21.366Z, duration_s: 301, tick_s: 1}
sensors:
  - name: vatt
    site: {latitude_deg: 32.7013, longitude_deg: -109.8920, height_m: 3178}
    camera:
      optics: {columns: 2032, rows: 2032, pixel_pitch_m: 30e-6, focal_length_m: 16.48, aperture_m: 1.83, obscuration: 0.21}
      detector: {quantum_efficiency: 0.6, read_noise_e: 5.1, full_well_e: 110000, gain_e_per_dn: 1.76, bias_dn: 0}
      band: bessell-V
      magnitude_system: AB
    pointing: {ra_deg: 144.768, dec_deg: 13.866, tracking: sidereal}
    exposure_s: 300
    cadence_s: 301
    sky: {preset: dark, solar_flux_sfu: 103}
    atmosphere: {extinction: kitt_peak}
)";
constexpr const char* about_vatt =
    "VATT: 1.83 m, secondary 0.38 m, f/9, 0.375 arcsec a pixel of 2 x 2; gain 1.76 e-/DN and read "
    "noise 5.1 e- are the mean "
    "of both amplifiers (Jansen 2011). No throughput is published that we know of: 0.6 is assumed "
    "of mirrors, filter and "
    "detector together, so its sky is known to a quarter. The header states no bias, which is "
    "taken as subtracted: the noise "
    "agrees with that.";

constexpr const char* about_lbc =
    "LBC: four pieces of 100 x 200 pixels at the edge of the detectors; the first is read. Its "
    "noise is less than the read "
    "noise of 12 e- that the header states, where a sky of 120 s in g would add 40 e-: it has no "
    "light, and nothing is "
    "predicted.";

}  // namespace

std::span<const RealFrame> real_frames() {
  static const std::vector<RealFrame> all{
      {.name = "sdss",
       .file = "cutout_frame-i-008108-5-0025.fits.gz",
       .camera = "SDSS, i",
       .scenario = sdss,
       .e_per_count = 4.64,
       .calibration = "NMGY",
       .about = about_sdss},
      {.name = "hsc",
       .file = "cutout_HSCA21787010.fits.gz",
       .camera = "Hyper Suprime-Cam, r2",
       .scenario = hsc,
       .stated = {{"EGAIN", "3.21"}},
       .first_dark_column = 1,
       .dark_columns = 7,
       .wanted_streaks = 1,
       .about = about_hsc},
      {.name = "vatt",
       .file = "cutout_m20211212UT_image0110.new.fits.gz",
       .camera = "VATT, V",
       .scenario = vatt,
       .stated = {{"EGAIN", "1.76"}, {"BIASLVL", "0"}},
       .wanted_streaks = 1,
       .about = about_vatt},
      {.name = "lbc",
       .file = "cutout_lbcb.20210407.120357.fits.gz",
       .camera = "LBC, g",
       .scenario = nullptr,
       .about = about_lbc},
  };
  return all;
}

}  // namespace dmise
