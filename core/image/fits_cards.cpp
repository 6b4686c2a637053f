#include "core/image/fits_cards.h"

#include <cmath>

#include "core/base/units.h"
#include "core/image/card_reader.h"
#include "core/image/card_writer.h"
#include "core/image/frame_keywords.h"

namespace dmise {
namespace {

void require_sense(const CardReader& v, const FrameHeader& h) {
  v.require(h.exposure_s > 0, "EXPTIME", "must be > 0");
  constexpr std::int64_t max_ns = 4'000'000'000'000'000'000;  // differences are in 64 bits, too
  v.require(h.start.ns >= -max_ns, "SIMT-BEG", "must be >= -4e18");
  v.require(h.end.ns <= max_ns, "SIMT-END", "must be <= 4e18");
  v.require(h.start <= h.middle && h.middle <= h.end, "SIMT-AVG", "must lie between start and end");
  v.require(h.gain_e_per_dn > 0, "GAIN", "must be > 0");
  v.require(h.read_noise_e >= 0, "RDNOISE", "must be >= 0");
  v.require(h.saturation_dn > 0, "SATURATE", "must be > 0");
  v.require(h.psf_fwhm_px > 0 && h.psf_fwhm_px <= 1e4, "PSFFWHM", "must be in (0, 1e4]");
  v.require(h.focal_length_px > 0, "FOCALPX", "must be > 0");
  const double row_time_us = h.detector ? h.detector->row_time_us : 0.0;
  v.require(row_time_us >= 0 && row_time_us <= 1e5, "ROWTIME", "must be in [0, 1e5]");
  if (h.site) {
    v.require(norm(h.sensor_position_m) > 0, "SENPOSX",
              "the sensor must not be the Earth's centre");
    v.require(std::abs(h.site->latitude_rad) <= 0.5 * pi, "SITELAT", "must be in [-90, 90]");
    v.require(h.band.centre_m >= 1e-7 && h.band.centre_m <= 1e-4, "BANDCEN",
              "must be in [1e-7, 1e-4] for a site's refraction");
  }
  if (h.air) {
    v.require(h.air->pressure_hpa >= 0 && h.air->pressure_hpa <= 1e4, "PRESSURE",
              "must be in [0, 10000]");
    v.require(h.air->temperature_c >= -150 && h.air->temperature_c <= 200, "AIRTEMP",
              "must be in [-150, 200]");
    v.require(h.air->humidity >= 0 && h.air->humidity <= 1, "HUMIDITY", "must be in [0, 1]");
  }
  const auto& cd = h.wcs.cd_deg;
  v.require(cd[0] * cd[3] - cd[1] * cd[2] != 0, "CD1_1", "the CD matrix must have an inverse");
  if (const auto& air = h.wcs.refraction) {
    v.require(std::abs(norm(air->zenith) - 1) < 1e-6, "WCSZENX", "the zenith must have length 1");
    v.require(air->focal_length_px > 0, "WCSFOC", "must be > 0");
    v.require(air->pressure_hpa >= 0 && air->pressure_hpa <= 1e4, "WCSPRES", "must be in 0..1e4");
    v.require(std::abs(air->temperature_c - 25) <= 175, "WCSTEMP", "must be in -150..200");
    v.require(air->humidity >= 0 && air->humidity <= 1, "WCSHUM", "must be in 0..1");
    v.require(air->wavelength_um >= 0.1 && air->wavelength_um <= 100, "WCSWAVE",
              "must be in 0.1..100");
    v.require(air->cell_px >= 1, "WCSCELL", "must be >= 1");
  }
  constexpr const char* attitudes[3] = {"QBEG0", "QAVG0", "QEND0"};
  for (std::size_t i = 0; i < 3; ++i) {
    const Quaternion& q = h.camera_from_gcrs[i];
    const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    v.require(std::abs(square - 1) < 1e-6, attitudes[i], "the quaternion must have length 1");
  }
}

}  // namespace

std::vector<std::string> fits_cards(const FrameHeader& header) {
  FrameHeader copy = header;
  CardWriter writer;
  visit(writer, copy);
  return std::move(writer.cards);
}

std::string text_card(const std::string& key, const std::string& value,
                      const std::string& comment) {
  CardWriter writer;
  writer.text(key, value, comment);
  return writer.cards.front();
}

std::string flag_card(const std::string& key, bool value, const std::string& comment) {
  CardWriter writer;
  writer.flag(key, value, comment);
  return writer.cards.front();
}

std::string integer_card(const std::string& key, std::int64_t value, const std::string& comment) {
  CardWriter writer;
  writer.integer(key, value, comment);
  return writer.cards.front();
}

std::string number_card(const std::string& key, double value, const std::string& comment) {
  CardWriter writer;
  writer.number(key, value, comment.c_str());
  return writer.cards.front();
}

void add_card(FitsValues& values, const std::string& card) {
  if (card.size() < 10 || card.compare(8, 2, "= ") != 0) return;
  const std::string key = card.substr(0, card.find_last_not_of(' ', 7) + 1);
  std::size_t at = card.find_first_not_of(' ', 10);
  std::string value;
  if (at != std::string::npos && card[at] == '\'') {
    for (++at; at < card.size(); ++at) {
      if (card[at] == '\'') {  // one ends the text, two are one of it
        ++at;
        if (at >= card.size() || card[at] != '\'') break;
      }
      value += card[at];
    }
  } else if (at != std::string::npos) {
    value = card.substr(at, card.find('/', at) - at);
  }
  value.resize(value.find_last_not_of(' ') + 1);
  values.emplace(key, value);
}

FrameHeader header_from_values(const FitsValues& values, const std::string& name) {
  FrameHeader header;
  CardReader reader(values, name);
  visit(reader, header);
  require_sense(reader, header);
  return header;
}

FrameHeader as_in_file(const FrameHeader& header) {
  FitsValues values;
  for (const std::string& card : fits_cards(header)) add_card(values, card);
  return header_from_values(values, "FITS header");
}

}  // namespace dmise
