#pragma once
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "core/image/card_text.h"
#include "core/ingest/any_frame.h"
#include "tests/ingest/foreign_file.h"
#include "tests/support/detect_frame.h"
#include "tests/support/simulated_frame.h"

// A simulated scene, and the same as a file of another camera.
namespace dmise::test {

inline constexpr int columns = 500, rows = 400;
inline constexpr double focal_px = 4000;

/// A scene of stars and two objects, as the program's own frame.
struct Scene {
  FrameHeader header;
  CountImage counts;
};

inline Scene draw(bool fixed_mount, double exposure_s, unsigned seed = 3) {
  FrameHeader h = simulated::camera_header(columns, rows, focal_px, 0.4, exposure_s, fixed_mount);
  simulated::SimulatedFrame frame(h, columns, rows, 200, seed);
  frame.add_stars(150, 1500, 60000);
  frame.add_streak(150, 300, 60, 0.5, 30000);
  frame.add_streak(330, 120, 35, 2.2, 8000);
  return {h, frame.expose()};
}

inline std::vector<std::string> wcs_cards(const FrameHeader& h) {
  const auto& cd = h.wcs.cd_deg;
  return {card("CTYPE1", "'RA---TAN'"),
          card("CTYPE2", "'DEC--TAN'"),
          card("CRPIX1", std::to_string(h.wcs.crpix_x + 1)),
          card("CRPIX2", std::to_string(h.wcs.crpix_y + 1)),
          card("CRVAL1", number_text(h.wcs.ra_rad / deg)),
          card("CRVAL2", number_text(h.wcs.dec_rad / deg)),
          card("CD1_1", number_text(cd[0])),
          card("CD1_2", number_text(cd[1])),
          card("CD2_1", number_text(cd[2])),
          card("CD2_2", number_text(cd[3]))};
}

inline std::vector<std::string> all_cards(const FrameHeader& h) {
  auto cards = wcs_cards(h);
  for (const auto& [key, value] :
       std::map<std::string, std::string>{{"INSTRUME", "'other'"},
                                          {"DATE-OBS", "'2018-01-20T23:40:00'"},
                                          {"EXPTIME", number_text(h.exposure_s)},
                                          {"EGAIN", number_text(h.gain_e_per_dn)},
                                          {"RDNOISE", "9.3"},
                                          {"PEDESTAL", "100"},
                                          {"SATURATE", "64000"},
                                          {"SITELAT", "40.0"},
                                          {"SITELONG", "-80.0"},
                                          {"SITEELEV", "300"}})
    cards.push_back(card(key, value));
  return cards;
}

inline ForeignImage image_of(const CountImage& counts, std::vector<std::string> cards) {
  return {.bitpix = USHORT_IMG,
          .shape = {counts.columns, counts.rows},
          .values = {counts.pixels.begin(), counts.pixels.end()},
          .cards = std::move(cards)};
}

inline std::vector<Frame> read(const std::string& bytes, const FrameChoice& choice = {}) {
  Threads one(1);
  std::vector<Frame> frames;
  decode_frames(bytes, "frame.fits", choice, one, [&](const Frame& f) { frames.push_back(f); });
  return frames;
}

inline Frame read_one(const ForeignImage& image, const FrameChoice& choice = {}) {
  auto frames = read(encoded(image), choice);
  EXPECT_EQ(frames.size(), 1u);
  return std::move(frames.at(0));
}

inline std::vector<Detection> detections_in(const Frame& frame) {
  Threads one(1);
  return detect_frame(frame, one).result.detections;
}

}  // namespace dmise::test
