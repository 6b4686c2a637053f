#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/numeric/monotone_cubic.h"
#include "core/base/units.h"
#include "core/image/card_text.h"
#include "core/image/fits_block.h"
#include "core/photometry/magnitude_system.h"
#include "core/products/frame_header.h"
#include "core/products/unknown_facts.h"
#include "core/wcs/wcs.h"

namespace dmise {

/// Visitor of a frame's keywords (core/image/frame_keywords.h) that writes cards of 80 characters.
/// Throws `Error` with the keyword if a value is not finite or a text does not fit.
class CardWriter {
 public:
  std::vector<std::string> cards;

  void number(const std::string& key, double value, const char* comment) {
    if (!std::isfinite(value)) throw Error("FITS header: " + key + ": not a finite number");
    add(key, number_text(value), comment);
  }
  void angle(const std::string& key, double value_rad, const char* comment) {
    number(key, value_rad / deg, comment);
  }
  template <class Integer>
  void integer(const std::string& key, Integer value, const std::string& comment) {
    add(key, std::to_string(value), comment);
  }
  void flag(const std::string& key, bool value, const std::string& comment) {
    add(key, value ? "T" : "F", comment);
  }
  void text(const std::string& key, const std::string& value, const std::string& comment) {
    if (value.size() > longest_card_text)
      throw Error("FITS header: " + key + ": longer than 64 characters: " + value);
    std::string quoted;
    for (const char c : value) {
      if (c < 0x20 || c > 0x7e) throw Error("FITS header: " + key + ": not printable ASCII");
      quoted += c;
      if (c == '\'') quoted += c;
    }
    if (quoted.size() > 68) throw Error("FITS header: " + key + ": too many quotes");
    quoted.resize(std::max<std::size_t>(quoted.size(), 8), ' ');
    add(key, "'" + quoted + "'", comment);
  }
  void facts(const char* key, const UnknownFacts& value, const char* comment) {
    text(key, value.text(), comment);
  }
  void utc(const std::string& key, const std::string& value, const char* comment) {
    text(key, value.substr(0, value.size() - value.ends_with('Z')), comment);
  }
  void constant(const char* key, const char* value, const char* comment) {
    text(key, value, comment);
  }
  void constant(const char* key, int value, const char* comment) { integer(key, value, comment); }
  void number_constant(const char* key, double value, const char* comment) {
    number(key, value, comment);
  }
  /// PHOTZP in the system that MAGSYS names.
  void zero_point(double zero_point_mag, const MagnitudeScale& scale, const char* comment) {
    number("PHOTZP", zero_point_mag, comment);
    constexpr std::array<const char*, 3> meanings{"V of a source of the Sun's colour",
                                                  "Vega has 0.03 in every band",
                                                  "3631 Jy at every wavelength"};
    const auto system = std::size_t(scale.system);
    constant("MAGSYS", magnitude_system_names[system], meanings[system]);
    if (scale.system != MagnitudeSystem::v_solar)
      number("SUNCOL", scale.solar_colour_mag, "[mag] the Sun's in it, less its V");
  }
  void projection(const char* key, const Projection& value, const char* comment) {
    constant(key, value.name(), comment);
    const auto coefficients = value.row().coefficients;
    for (std::size_t i = 0; i < coefficients.size(); ++i)
      number(coefficients[i].card, value.coefficients()[i], coefficients[i].comment);
  }
  void optional_text(const char* key, const std::string& value, const char* comment) {
    if (!value.empty()) text(key, value, comment);
  }
  void optional_number(const char* key, std::optional<double> value, const char* comment) {
    if (value) number(key, *value, comment);
  }
  void optional_angle(const char* key, std::optional<double> value_rad, const char* comment) {
    if (value_rad) angle(key, *value_rad, comment);
  }
  void wcs_projection(const Wcs& wcs, bool sip) {
    const Projection::Row& row = wcs.projection.row();
    const std::string tail = row.fits_code + std::string(sip ? "-SIP" : "");
    text("CTYPE1", "RA---" + tail, sip ? "with SIP distortion" : "");
    text("CTYPE2", "DEC--" + tail, "");
    if (row.coefficients.empty()) return;
    number_constant("PV2_1", 1.0, "image height: theta and more powers of it [rad]");
    for (std::size_t i = 0; i < row.coefficients.size(); ++i)
      number("PV2_" + std::to_string(row.coefficients[i].pv), wcs.projection.coefficients()[i], "");
  }
  /// Records of a distortion by table lookup, which share one keyword.
  void lookup(int axis) {
    const std::string number = std::to_string(axis);
    text("CPDIS" + number, "LOOKUP", "the air, by a table in the extension WCSDVARR");
    for (const char* record : {"EXTVER: ", "NAXES: 2", "AXIS.1: 1", "AXIS.2: 2"})
      text("DP" + number, record + std::string(record[0] == 'E' ? number : ""), "");
  }
  bool present(const char*, bool here) const { return here; }
  template <class Enum, std::size_t count>
  void choice(const char* key, Enum value, const char* const (&names)[count], const char* comment) {
    constant(key, names[std::size_t(value)], comment);
  }
  /// The rows of a vignetting table.
  void illumination(const MonotoneCubic& table, FieldRadius radius) {
    integer("VIGNROWS", table.at().size(), "rows of the relative illumination");
    text("VIGNUNIT", unit_text(radius), "of the distances VIGRn from the axis");
    for (std::size_t i = 0; i < table.at().size(); ++i) {
      const std::string row = std::to_string(i + 1);
      number("VIGR" + row, table.at()[i], "");
      number("VIGT" + row, table.value()[i], i == 0 ? "light there, relative to the axis" : "");
    }
  }
  void sip(const Wcs& wcs) {
    if (wcs.order == 0) return;
    if (wcs.order < 0 || wcs.order > highest_sip_order)
      throw Error("FITS header: A_ORDER: not in 0..9");
    const auto polynomial = [&](const std::string& name, const std::vector<double>& coefficients) {
      const auto side = std::size_t(wcs.order) + 1;
      if (coefficients.size() != side * side)
        throw Error("FITS header: " + name + "_ORDER: coefficients missing");
      add(name + "_ORDER", std::to_string(wcs.order), "order of the SIP polynomial");
      for (std::size_t p = 0; p < side; ++p)
        for (std::size_t q = 0; p + q < side; ++q) {
          const double c = coefficients[p * side + q];
          if (c != 0.0) number(name + "_" + std::to_string(p) + "_" + std::to_string(q), c, "");
        }
    };
    polynomial("A", wcs.a);
    polynomial("B", wcs.b);
    polynomial("AP", wcs.ap);
    polynomial("BP", wcs.bp);
  }

 private:
  void add(const std::string& key, const std::string& value, const std::string& comment) {
    std::string card = key;
    card.resize(8, ' ');
    card += "= ";
    if (value[0] != '\'' && value.size() < 20) card.append(20 - value.size(), ' ');
    card += value;
    if (!comment.empty()) {
      if (card.size() < 30) card.resize(30, ' ');
      card += " / " + comment;
    }
    card.resize(fits_card_bytes, ' ');
    cards.push_back(std::move(card));
  }
};

}  // namespace dmise
