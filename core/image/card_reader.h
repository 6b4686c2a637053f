#pragma once
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/numeric/monotone_cubic.h"
#include "core/base/units.h"
#include "core/image/card_text.h"
#include "core/image/fits_cards.h"
#include "core/photometry/magnitude_system.h"
#include "core/products/frame_header.h"
#include "core/wcs/wcs.h"

namespace dmise {

/// Visitor of a frame's keywords (core/image/frame_keywords.h) that reads the values of cards.
/// Throws `ConfigError` "NAME: KEYWORD: reason".
class CardReader {
 public:
  CardReader(const FitsValues& values, const std::string& name) : values_(values), name_(name) {}

  void number(const std::string& key, double& value, const char*) {
    const std::string& text = find(key);
    if (!parse_number(text, value)) fail(key, "must be a finite number, got " + text);
  }
  void angle(const std::string& key, double& value_rad, const char*) {
    double degrees = 0.0;
    number(key, degrees, "");
    value_rad = degrees * deg;
  }
  template <class Integer>
  void integer(const std::string& key, Integer& value, const char*) {
    const std::string& text = find(key);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      fail(key, "must be an integer in range, got " + text);
  }
  void flag(const std::string& key, bool& value, const char*) {
    const std::string& text = find(key);
    if (text != "T" && text != "F") fail(key, "must be T or F, got " + text);
    value = text == "T";
  }
  void text(const std::string& key, std::string& value, const char*) { value = find(key); }
  void facts(const char* key, UnknownFacts& value, const char*) {
    const auto named = UnknownFacts::of_text(find(key));
    if (!named) fail(key, "holds a word that names no fact, got " + find(key));
    value = *named;
  }
  void utc(const std::string& key, std::string& value, const char*) { value = find(key); }
  void constant(const char* key, const char* value, const char*) {
    if (find(key) != value) fail(key, std::string("must be ") + value + ", got " + find(key));
  }
  void constant(const char* key, int value, const char*) {
    constant(key, std::to_string(value).c_str(), "");
  }
  void number_constant(const char* key, double value, const char*) {
    double found = 0.0;
    number(key, found, "");
    if (found != value) fail(key, "must be " + number_text(value) + ", got " + find(key));
  }
  /// Without MAGSYS it is V-solar.
  void zero_point(double& zero_point_mag, MagnitudeScale& scale, const char*) {
    number("PHOTZP", zero_point_mag, "");
    scale = {};
    if (!values_.contains("MAGSYS")) return;
    const auto system = magnitude_system_of(find("MAGSYS"));
    if (!system) fail("MAGSYS", "must be V-solar, Vega or AB, got " + find("MAGSYS"));
    scale.system = *system;
    if (*system != MagnitudeSystem::v_solar) number("SUNCOL", scale.solar_colour_mag, "");
  }
  void projection(const char* key, Projection& value, const char*) {
    const auto named = Projection::index_of_name(find(key));
    if (!named) fail(key, "not a projection, got " + find(key));
    value = with_coefficients(key, *named,
                              [](const ProjectionCoefficient& c) -> std::string { return c.card; });
  }
  void illumination(MonotoneCubic& table, FieldRadius& radius) {
    constexpr int max_rows = 1000;
    int rows = 0;
    integer("VIGNROWS", rows, "");
    if (rows < 1 || rows > max_rows) fail("VIGNROWS", "must be 1 to 1000");
    const std::string& unit = find("VIGNUNIT");
    if (unit != unit_text(FieldRadius::angle_deg) && unit != unit_text(FieldRadius::distance_px))
      fail("VIGNUNIT", "must be deg or px, got " + unit);
    radius = unit == unit_text(FieldRadius::angle_deg) ? FieldRadius::angle_deg
                                                       : FieldRadius::distance_px;
    std::vector<double> at(static_cast<std::size_t>(rows)), value(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
      const std::string row = std::to_string(i + 1);
      number("VIGR" + row, at[i], "");
      number("VIGT" + row, value[i], "");
      if (i > 0 && !(at[i] > at[i - 1])) fail("VIGR" + row, "must rise");
    }
    table = MonotoneCubic(std::move(at), std::move(value));
  }
  // Values of other types in foreign files (RA as a text) are ignored.
  void optional_text(const char* key, std::string& value, const char*) {
    const auto at = values_.find(key);
    value = at == values_.end() ? "" : header_text(at->second);
  }
  void optional_number(const char* key, std::optional<double>& value, const char*) {
    value.reset();
    const auto at = values_.find(key);
    if (at == values_.end()) return;
    double found = 0.0;
    if (parse_number(at->second, found)) value = found;
  }
  void optional_angle(const char* key, std::optional<double>& value_rad, const char*) {
    optional_number(key, value_rad, "");
    if (value_rad) *value_rad *= deg;
  }
  void wcs_projection(Wcs& wcs, bool sip) {
    const std::string& type = find("CTYPE1");
    const auto row = Projection::index_of_fits_code(
        std::string_view(type).substr(std::min<std::size_t>(5, type.size()), 3));
    if (!row) {
      std::string codes;
      for (const auto& known : Projection::rows())
        if (known.fits_code) codes += (codes.empty() ? "" : ", -") + std::string(known.fits_code);
      fail("CTYPE1", "must be RA---" + codes + ", with or without -SIP, got " + type);
    }
    wcs.projection = with_coefficients("CTYPE1", *row, [](const ProjectionCoefficient& c) {
      return "PV2_" + std::to_string(c.pv);
    });
    if (!wcs.projection.coefficients().empty()) number_constant("PV2_1", 1.0, "");
    const std::string tail = wcs.projection.row().fits_code + std::string(sip ? "-SIP" : "");
    constant("CTYPE1", ("RA---" + tail).c_str(), "");
    constant("CTYPE2", ("DEC--" + tail).c_str(), "");
  }
  void lookup(int axis) { constant(("CPDIS" + std::to_string(axis)).c_str(), "LOOKUP", ""); }
  bool present(const char* key, bool) const { return values_.contains(key); }
  template <class Enum, std::size_t count>
  void choice(const char* key, Enum& value, const char* const (&names)[count], const char*) {
    const auto named = std::ranges::find(names, find(key));
    if (named == std::end(names)) fail(key, "is no such choice, got " + find(key));
    value = Enum(named - std::begin(names));
  }
  void sip(Wcs& wcs) {
    if (!values_.contains("A_ORDER")) return;
    integer("A_ORDER", wcs.order, "");
    if (wcs.order < 1 || wcs.order > highest_sip_order) fail("A_ORDER", "must be in 1..9");
    const auto polynomial = [&](const std::string& name, std::vector<double>& coefficients) {
      constant((name + "_ORDER").c_str(), wcs.order, "");
      const auto side = std::size_t(wcs.order) + 1;
      coefficients.assign(side * side, 0.0);
      for (std::size_t p = 0; p < side; ++p)
        for (std::size_t q = 0; p + q < side; ++q) {
          const std::string key = name + "_" + std::to_string(p) + "_" + std::to_string(q);
          if (values_.contains(key)) number(key, coefficients[p * side + q], "");
        }
    };
    polynomial("A", wcs.a);
    polynomial("B", wcs.b);
    polynomial("AP", wcs.ap);
    polynomial("BP", wcs.bp);
  }
  void require(bool holds, const char* key, const char* condition) const {
    if (!holds) fail(key, std::string(condition) + ", got " + find(key));
  }

 private:
  /// The projection of a row of the table; `card_of` returns the keyword of a coefficient.
  template <class CardOf>
  Projection with_coefficients(const char* key, std::size_t index, const CardOf& card_of) {
    std::vector<double> coefficients;
    for (const auto& c : Projection::rows()[index].coefficients)
      number(card_of(c), coefficients.emplace_back(), "");
    try {
      return Projection::make(index, coefficients);
    } catch (const Error& error) {
      fail(key, error.what());
    }
  }
  [[noreturn]] void fail(const std::string& key, const std::string& reason) const {
    throw ConfigError(name_ + ": " + key + ": " + reason);
  }
  const std::string& find(const std::string& key) const {
    const auto at = values_.find(key);
    if (at == values_.end()) fail(key, "is missing");
    return at->second;
  }
  static bool parse_number(std::string text, double& value) {
    for (char& c : text)
      if (c == 'D' || c == 'd') c = 'E';  // FITS allows the exponent of a double to be marked D
    if (text.starts_with('+')) text.erase(0, 1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  }

  const FitsValues& values_;
  const std::string& name_;
};

}  // namespace dmise
