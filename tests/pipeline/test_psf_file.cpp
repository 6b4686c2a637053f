// Frames whose point spread is that of images in a FITS file, beside sums of Gaussians over pixels.

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>

#include "core/config/sensors/optics_config.h"
#include "tests/pipeline/shape_scenes.h"
#include "tests/support/config_error.h"

namespace dmise::test {
namespace {

/// Part of an image: a round Gaussian beside the middle [px].
struct Spot {
  double x_px = 0.0, y_px = 0.0, sigma_px = 0.8, share = 1.0;
};
using Spots = std::vector<Spot>;
const Spots lopsided{{0, 0, 0.7, 0.6}, {1.3, -0.4, 1.1, 0.3}, {-0.8, 2.1, 0.9, 0.1}};

/// Integral of the spots over a square of side `wide_px` about a place; 0: their value there.
double light_at(const Spots& spots, double x, double y, double wide_px) {
  double sum = 0.0;
  for (const Spot& s : spots) {
    const auto along = [&](double d) {
      if (wide_px == 0.0)
        return std::exp(-0.5 * d * d / (s.sigma_px * s.sigma_px)) /
               (std::sqrt(2 * pi) * s.sigma_px);
      const double scale = std::sqrt(2.0) * s.sigma_px;
      return 0.5 * (std::erf((d + wide_px / 2) / scale) - std::erf((d - wide_px / 2) / scale));
    };
    sum += s.share * along(x - s.x_px) * along(y - s.y_px);
  }
  return sum;
}

struct Images {
  std::vector<Spots> planes{lopsided};
  int columns = 81, rows = 71;
  double samples_per_px = 5.0;
  bool with_pixel = false;
  std::vector<std::string> cards;

  std::vector<double> values(const Spots& spots) const {
    std::vector<double> values;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i)
        values.push_back(light_at(spots, (i - 0.5 * (columns - 1)) / samples_per_px,
                                  (j - 0.5 * (rows - 1)) / samples_per_px, with_pixel));
    return values;
  }
  std::string header() const {
    std::vector<std::string> all{"SIMPLE  =                    T", "BITPIX  =                  -64",
                                 "NAXIS   = " + std::to_string(planes.size() > 1 ? 3 : 2),
                                 "NAXIS1  = " + std::to_string(columns),
                                 "NAXIS2  = " + std::to_string(rows)};
    if (planes.size() > 1) all.push_back("NAXIS3  = " + std::to_string(planes.size()));
    all.insert(all.end(), cards.begin(), cards.end());
    all.push_back("END");
    std::string text;
    for (std::string& card : all) text += card.append(80 - card.size(), ' ');
    return text.append((2880 - text.size() % 2880) % 2880, ' ');
  }
  /// Its path, above the directories of the scenes.
  std::string written() const {
    std::string bytes = header();
    for (const Spots& spots : planes)
      for (const double value : values(spots)) {
        const auto word = std::bit_cast<std::uint64_t>(value);
        for (int byte = 7; byte >= 0; --byte) bytes += char(word >> (8 * byte));
      }
    bytes.append((2880 - bytes.size() % 2880) % 2880, '\0');
    const std::string name = "/psf.fits";
    std::ofstream(testing::TempDir() + name, std::ios::binary) << bytes;
    return ".." + name;
  }
};

/// An object 1e5 m away, through `spread`, beside the middle of 65 x 65 pixels.
std::string scene_of(const std::string& spread, double right_m = 0.0, double down_m = 0.0,
                     const std::string& range_defocus = "off") {
  const Sight sight = lit_sight();
  return text_of(
      {.objects = shape_at("ball", sight, 1e5, right_m, down_m, "    radius_m: 0.012\n") +
                  shape_at("middle", sight, 3e7, 0, 0, "    radius_m: 1e-6\n"),
       .pointing = "{target: middle}",
       .optics = "{columns: 65, rows: 65, pixel_pitch_m: 1.0e-5, focal_length_m: 1, "
                 "aperture_m: 0.4, " +
                 spread + "}",
       .range_defocus = range_defocus});
}

std::string file_key(const Images& images, const std::string& more = "") {
  char text[256];
  std::snprintf(text, sizeof text, "psf: file, psf_file: {path: %s, samples_per_px: %g%s}%s",
                images.written().c_str(), images.samples_per_px,
                images.with_pixel ? ", with_pixel: on" : "", more.c_str());
  return text;
}

/// The worst pixel of a frame, over the brightest, beside the spots at a place.
double worst_pixel(const FrameProducts& frame, const Spots& spots, PixelPosition at) {
  const auto& h = frame.header;
  double sum = 0.0, worst = 0.0, peak = 0.0;
  for (const auto count : frame.counts.pixels) sum += count - h.bias_dn;
  for (int y = 0; y < frame.counts.rows; ++y)
    for (int x = 0; x < frame.counts.columns; ++x) {
      const double wanted = sum * light_at(spots, x - at.x_px, y - at.y_px, 1.0);
      worst = std::max(worst, std::abs(frame.counts.at(x, y) - h.bias_dn - wanted));
      peak = std::max(peak, wanted);
    }
  EXPECT_GT(peak, 5000.0);
  EXPECT_LT(peak, 6e4);
  return worst / peak;
}

constexpr double px_m = 1.0;  // a pixel at 1e5 m

/// Where an object stands that is so far aside.
PixelPosition place_of(double right_m, double down_m) {
  return {32 + right_m / px_m, 32 + down_m / px_m};
}

TEST(PsfFile, ImagesAreIntegratedOverPixels) {
  for (const double samples : {3.0, 5.0, 8.0})
    for (const auto& [right, down] : {std::pair{0.0, 0.0}, {0.37 * px_m, -0.21 * px_m}}) {
      const Images images{
          .columns = int(16 * samples) + 1, .rows = int(15 * samples), .samples_per_px = samples};
      Stage stage(scene_of(file_key(images), right, down));
      EXPECT_LT(worst_pixel(stage.frame(), lopsided, place_of(right, down)), 1e-3) << samples;
    }
}

TEST(PsfFile, AnEffectivePointSpreadHasThePixelInIt) {
  Images images{.with_pixel = true};
  for (const double samples : {4.0, 5.0}) {
    images.samples_per_px = samples;
    Stage stage(scene_of(file_key(images), 0.37, 0.11));
    EXPECT_LT(worst_pixel(stage.frame(), lopsided, place_of(0.37, 0.11)), 4e-3) << samples;
  }
}

TEST(PsfFile, CardsTellTheSampling) {
  const auto with = [](const std::string& card) {
    Images images{.cards = {card}};
    return scene_of("psf: file, psf_file: " + images.written());
  };
  for (const char* card : {"OVERSAMP= 5", "PSF_SAMP= 0.2", "PIXELSCL= 0.412529612494"}) {
    Stage stage(with(card));
    EXPECT_LT(worst_pixel(stage.frame(), lopsided, place_of(0, 0)), 1e-3) << card;
  }
  EXPECT_NE(config_error_of([&] { Stage stage(with("FOCUS   = 5")); })
                .find("psf_file: needs samples_per_px: the file has no card OVERSAMP, PSF_SAMP or "
                      "PIXELSCL"),
            std::string::npos);
}

// Narrow to the left of the frame, wide to the right of it. Deposits on cells reach over others of
// another kernel, which in 1000 px misplaces nothing and in 64 px 0.002 px.
TEST(PsfFile, PlacesOfTheFieldAreLinearBetween) {
  const Spots narrow{{0, 0, 0.7, 1}}, wide{{0, 0, 1.4, 1}};
  const Images images{.planes = {narrow, wide},
                      .cards = {"DET_YX0 = '(32, -480)'", "DET_YX1 = '(32.0, 544.0)'"}};
  for (const auto& [right, down] : {std::pair{0.25, 0.1}, {-15.3, 7.2}, {20.0, -9.6}}) {
    Stage stage(scene_of(file_key(images), right, down));
    const auto at = place_of(right, down);
    const double share = (at.x_px + 480) / 1024;
    const Spots here{{0, 0, 0.7, 1 - share}, {0, 0, 1.4, share}};
    EXPECT_LT(worst_pixel(stage.frame(), here, at), 1e-3) << right;
  }
}

// The band is 0.5 to 0.6 um; one wavelength is at its middle.
TEST(PsfFile, WavelengthsAreWeighedByTheBand) {
  const Spots narrow{{0, 0, 0.7, 1}}, wide{{0, 0, 1.4, 1}};
  const Images images{.planes = {narrow, wide},
                      .cards = {"WAVELN00= 0.45E-6", "WAVELN01= 0.65E-6"}};
  Stage stage(scene_of(file_key(images)));
  const Spots mean{{0, 0, 0.7, 0.5}, {0, 0, 1.4, 0.5}};
  EXPECT_LT(worst_pixel(stage.frame(), mean, place_of(0, 0)),
            0.02);  // sunlight is no flat spectrum
}

// Out of focus the images are blurred by the disc, so their variance grows by D^2 / (16 R^2).
TEST(PsfFile, ObjectsAreOutOfFocusByTheirRange) {
  const Images images{.planes = {{{0, 0, 0.8, 1}}}};
  const auto variance = [&](const std::string& range_defocus) {
    Stage stage(scene_of(file_key(images), 0, 0, range_defocus));
    const auto frame = stage.frame();
    const auto at = centroid(frame.counts, {32, 32}, 30);
    double sum = 0, square = 0;
    for (int y = 0; y < 65; ++y)
      for (int x = 0; x < 65; ++x) {
        const double light = frame.counts.at(x, y) - frame.header.bias_dn;
        sum += light;
        square += light * (std::pow(x - at.x_px, 2) + std::pow(y - at.y_px, 2));
      }
    return square / sum / 2;
  };
  const double disc_px = 0.4 / 1e5 / 1e-5;
  EXPECT_NEAR(variance("0.3%") - variance("off"), disc_px * disc_px / 16, 2e-3);
}

TEST(PsfFile, TheDigestHasItsContent) {
  const auto digest = [](const Spots& spots) {
    const Stage stage(scene_of(file_key({.planes = {spots}})));
    JsonWriter json;
    json.begin_object();
    write_optics_json(json, stage.scenario.sensors[0].camera.optics);
    return std::string(json.end_object().text());
  };
  EXPECT_EQ(digest(lopsided), digest(lopsided));
  EXPECT_NE(digest(lopsided), digest({{0, 0, 0.8, 1}}));
}

TEST(PsfFile, WhatItCannotBeIsRefused) {
  const auto refusal = [](const std::string& spread) {
    return config_error_of([&] { Stage stage(scene_of(spread)); });
  };
  const auto says = [&](const std::string& spread, const std::string& text) {
    const std::string error = refusal(spread);
    EXPECT_NE(error.find(text), std::string::npos) << error;
  };
  says("psf: file", "psf: needs a psf_file");
  says("psf: gaussian, psf_file: x.fits", "psf_file: goes with psf: file");
  says("psf: file, psf_file: nowhere.fits", "psf_file");
  says(file_key({}, ", psf_fwhm_px: 2"), "psf_fwhm_px: can't stand beside psf: file");
  says(file_key({}, ", defocus_m: 1.0e-3"), "defocus_m: goes with psf: diffraction");
  says(file_key({}, ", method: deposit"), "deposit is for psf: gaussian");
  says(file_key({.planes = {{{0, 0, 0.8, -1}}}}), "the sum of an image must be above 0");
  says(file_key({.planes = {{{0, 0, std::nan(""), 1}}}}), "pixel (1, 1) of plane 0 has no value");
  says(file_key({.planes = {lopsided, lopsided}}), "plane 0 of 2 has neither DET_YX0 nor WAVELN00");
  says(file_key(
           {.planes = {lopsided, lopsided}, .cards = {"DET_YX0 = '(3, 4)'", "DET_YX1 = '(4, 3)'"}}),
       "places must be a grid with all wavelengths, 4 planes, got 2");
  says(file_key(
           {.planes = {lopsided, lopsided}, .cards = {"DET_YX0 = '(3, 4)'", "DET_YX1 = 'left'"}}),
       "DET_YX1: must be (y, x), got left");
  says(file_key({.with_pixel = true}, ", resampling: area"), "resampling: images with the pixel");
}

}  // namespace
}  // namespace dmise::test
