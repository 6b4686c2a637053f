#include "core/image/fits_cards.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/detector/detector.h"
#include "core/image/observation_cards.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

constexpr std::size_t card_size = 80;
constexpr std::size_t longest_text = 64;  // as long as a sensor's name may be
constexpr int highest_order = 9;          // of SIP polynomials, by its convention

std::string number_text(double value) {
  char buffer[40];
  std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  for (char& c : text)
    if (c == 'e') c = 'E';
  if (text.find_first_of(".E") == std::string::npos) text += ".0";
  return text;
}

/// One visitor writes, one reads; `visit` names every keyword once for both.
class CardWriter {
 public:
  std::vector<std::string> cards;

  void number(const std::string& key, double& value, const char* comment) {
    if (!std::isfinite(value)) throw Error("FITS header: " + key + ": not a finite number");
    add(key, number_text(value), comment);
  }
  void angle(const std::string& key, double& value_rad, const char* comment) {
    double degrees = value_rad / deg;
    number(key, degrees, comment);
  }
  template <class Integer>
  void integer(const std::string& key, const Integer& value, const std::string& comment) {
    add(key, std::to_string(value), comment);
  }
  void flag(const std::string& key, const bool& value, const std::string& comment) {
    add(key, value ? "T" : "F", comment);
  }
  void text(const std::string& key, const std::string& value, const std::string& comment) {
    if (value.size() > longest_text)
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
  void utc(const std::string& key, std::string& value, const char* comment) {
    std::string without_z = value.ends_with('Z') ? value.substr(0, value.size() - 1) : value;
    text(key, without_z, comment);
  }
  void constant(const char* key, const char* value, const char* comment) {
    std::string copy = value;
    text(key, copy, comment);
  }
  void constant(const char* key, int value, const char* comment) { integer(key, value, comment); }
  void number_constant(const char* key, double value, const char* comment) {
    number(key, value, comment);
  }
  void projection(const char* key, Projection& value, const char* comment) {
    constant(key, value.name(), comment);
    const auto coefficients = value.row().coefficients;
    for (std::size_t i = 0; i < coefficients.size(); ++i) {
      double coefficient = value.coefficients()[i];
      number(coefficients[i].card, coefficient, coefficients[i].comment);
    }
  }
  void optional_text(const char* key, std::string& value, const char* comment) {
    if (!value.empty()) text(key, value, comment);
  }
  void optional_number(const char* key, std::optional<double>& value, const char* comment) {
    if (value) number(key, *value, comment);
  }
  void optional_angle(const char* key, std::optional<double>& value_rad, const char* comment) {
    if (value_rad) angle(key, *value_rad, comment);
  }
  void wcs_projection(Wcs& wcs, bool sip) {
    const Projection::Row& row = wcs.projection.row();
    const std::string tail = row.fits_code + std::string(sip ? "-SIP" : "");
    text("CTYPE1", "RA---" + tail, sip ? "with SIP distortion" : "");
    text("CTYPE2", "DEC--" + tail, "");
    if (row.coefficients.empty()) return;
    number_constant("PV2_1", 1.0, "image height: theta and more powers of it [rad]");
    for (std::size_t i = 0; i < row.coefficients.size(); ++i) {
      double coefficient = wcs.projection.coefficients()[i];
      number("PV2_" + std::to_string(row.coefficients[i].pv), coefficient, "");
    }
  }
  /// The records of a distortion by table lookup: a keyword for several of them.
  void lookup(int axis) {
    const std::string number = std::to_string(axis);
    text("CPDIS" + number, "LOOKUP", "the air, by a table in the extension WCSDVARR");
    for (const char* record : {"EXTVER: ", "NAXES: 2", "AXIS.1: 1", "AXIS.2: 2"})
      text("DP" + number, record + std::string(record[0] == 'E' ? number : ""), "");
  }
  bool present(const char*, bool here) const { return here; }
  void sip(Wcs& wcs) {
    if (wcs.order == 0) return;
    if (wcs.order < 0 || wcs.order > highest_order)
      throw Error("FITS header: A_ORDER: not in 0..9");
    const auto polynomial = [&](const std::string& name, const std::vector<double>& coefficients) {
      const auto side = std::size_t(wcs.order) + 1;
      if (coefficients.size() != side * side)
        throw Error("FITS header: " + name + "_ORDER: coefficients missing");
      add(name + "_ORDER", std::to_string(wcs.order), "order of the SIP polynomial");
      for (std::size_t p = 0; p < side; ++p)
        for (std::size_t q = 0; p + q < side; ++q) {
          double c = coefficients[p * side + q];
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
    card.resize(card_size, ' ');
    cards.push_back(std::move(card));
  }
};

class CardReader {
 public:
  CardReader(const FitsValues& values, const std::string& name) : values_(values), name_(name) {}

  void number(const std::string& key, double& value, const char*) {
    value = number_of(key, find(key));
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
  void projection(const char* key, Projection& value, const char*) {
    const auto named = Projection::index_of_name(find(key));
    if (!named) fail(key, "not a projection, got " + find(key));
    value = with_coefficients(key, *named,
                              [](const ProjectionCoefficient& c) -> std::string { return c.card; });
  }
  // What files from elsewhere say otherwise than we do (RA as a text) is not taken.
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
  void sip(Wcs& wcs) {
    if (!values_.contains("A_ORDER")) return;
    integer("A_ORDER", wcs.order, "");
    if (wcs.order < 1 || wcs.order > highest_order) fail("A_ORDER", "must be in 1..9");
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
  /// The projection of a row of the table; `card_of` names the keyword of a coefficient.
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
  double number_of(const std::string& key, const std::string& text) const {
    double value = 0.0;
    if (!parse_number(text, value)) fail(key, "must be a finite number, got " + text);
    return value;
  }

  const FitsValues& values_;
  const std::string& name_;
};

template <class Visitor>
void visit_pixel_coordinate(Visitor& v, const char* key, double& zero_based, const char* comment) {
  double one_based = zero_based + 1.0;
  v.number(key, one_based, comment);
  zero_based = one_based - 1.0;
}

template <class Visitor, class Frame>
void visit_vector(Visitor& v, const std::string& key, Vec<Frame>& vector, const char* comment) {
  v.number(key + "X", vector.x, comment);
  v.number(key + "Y", vector.y, "");
  v.number(key + "Z", vector.z, "");
}

template <class Visitor>
void visit_refraction(Visitor& v, const Projection& lens, Wcs& wcs) {
  if (!v.present("CPDIS1", wcs.refraction.has_value())) return;
  if (!wcs.refraction) wcs.refraction.emplace();
  WcsRefraction& r = *wcs.refraction;
  if (!lens.row().fits_code) r.lens = lens;
  v.lookup(1);
  v.lookup(2);
  visit_vector(v, "WCSZEN", r.zenith, "zenith in the camera: right, down, boresight");
  v.number("WCSFOC", r.focal_length_px, "[px] focal length");
  v.number("WCSPRES", r.pressure_hpa, "[hPa] of the air that refracts");
  v.number("WCSTEMP", r.temperature_c, "[degC]");
  v.number("WCSHUM", r.humidity, "relative humidity");
  v.number("WCSWAVE", r.wavelength_um, "[um] wavelength");
  v.number("WCSOFFX", r.offset_x_px, "[px] left out of the lookup tables");
  v.number("WCSOFFY", r.offset_y_px, "");
  v.number("WCSCELL", r.cell_px, "[px] step of the lookup tables");
}

template <class Visitor>
void visit_wcs(Visitor& v, const Projection& lens, Wcs& wcs) {
  const bool sip = v.present("A_ORDER", wcs.order > 0);
  v.constant("WCSAXES", 2, "");
  v.wcs_projection(wcs, sip);
  v.constant("CUNIT1", "deg", "");
  v.constant("CUNIT2", "deg", "");
  visit_pixel_coordinate(v, "CRPIX1", wcs.crpix_x, "centre of the first pixel is 1");
  visit_pixel_coordinate(v, "CRPIX2", wcs.crpix_y, "");
  v.angle("CRVAL1", wcs.ra_rad, "[deg] right ascension of the reference pixel");
  v.angle("CRVAL2", wcs.dec_rad, "[deg] declination of the reference pixel");
  v.number("CD1_1", wcs.cd_deg[0], "[deg/px]");
  v.number("CD1_2", wcs.cd_deg[1], "[deg/px]");
  v.number("CD2_1", wcs.cd_deg[2], "[deg/px]");
  v.number("CD2_2", wcs.cd_deg[3], "[deg/px]");
  v.number_constant("LONPOLE", 180.0, "[deg] also where the reference is a celestial pole");
  v.constant("RADESYS", "ICRS", "places are astrometric: as in a star catalogue");
  v.sip(wcs);
  visit_refraction(v, lens, wcs);
  v.number("WCSRMS", wcs.rms_px, "[px] rms of the WCS where the sky is seen");
  v.number("WCSMAX", wcs.max_px, "[px] largest error of the WCS there");
}

template <class Visitor>
void visit_field(Visitor& v, const std::string& key, double& value, const char* comment) {
  v.number(key, value, comment);
}
template <class Visitor>
void visit_field(Visitor& v, const std::string& key, int& value, const char* comment) {
  v.integer(key, value, comment);
}
template <class Visitor>
void visit_field(Visitor& v, const std::string& key, bool& value, const char* comment) {
  v.flag(key, value, comment);
}

// Those of the figures that every frame states are copied from there, not written twice.
template <class Visitor>
void visit_detector(Visitor& v, FrameHeader& h) {
  if (!v.present("ADCBITS", h.detector.has_value())) return;
  if (!h.detector) h.detector.emplace();
  Detector& d = *h.detector;
  for (const DetectorParameter& p : detector_parameters()) {
    const std::string keyword(p.keyword), comment(p.meaning);
    const bool unusual = p.number_of(d) != p.number_of({});
    if (!keyword.empty() && (in_every_header(p) || v.present(keyword.c_str(), unusual)))
      std::visit([&](auto member) { visit_field(v, keyword, d.*member, comment.c_str()); },
                 p.value);
  }
  d.dark_e_per_s = h.dark_e_per_s;
  d.read_noise_e = h.read_noise_e;
  d.full_well_e = h.full_well_e;
  d.gain_e_per_dn = h.gain_e_per_dn;
  d.bias_dn = h.bias_dn;
}

template <class Visitor>
void visit(Visitor& v, FrameHeader& h) {
  v.text("INSTRUME", h.sensor, "sensor");
  visit_observation(v, h.observation);
  v.integer("FRAMENUM", h.frame, "frame of this sensor, counts from 1");
  v.constant("TIMESYS", "UTC", "");
  v.utc("DATE-OBS", h.start_utc, "start of the exposure");
  v.utc("DATE-BEG", h.start_utc, "start of the exposure");
  v.utc("DATE-AVG", h.middle_utc, "middle of the exposure");
  v.utc("DATE-END", h.end_utc, "end of the exposure");
  v.integer("SIMT-BEG", h.start.ns, "[ns] start, since the scenario's start");
  v.integer("SIMT-AVG", h.middle.ns, "[ns] middle");
  v.integer("SIMT-END", h.end.ns, "[ns] end");
  v.number("EXPTIME", h.exposure_s, "[s]");
  v.text("MOUNT", h.mount, "how the camera is carried");
  v.text("FILTER", h.band.name, "band");
  v.number("BANDCEN", h.band.centre_m, "[m] centre of the band");
  v.number("BANDWID", h.band.width_m, "[m] full width of the band");
  v.number("GAIN", h.gain_e_per_dn, "[e-/DN]");
  v.number("BIASLVL", h.bias_dn, "[DN] count of no electron");
  v.number("RDNOISE", h.read_noise_e, "[e-] rms");
  v.number("DARKCUR", h.dark_e_per_s, "[e-/s/px]");
  v.number("FULLWELL", h.full_well_e, "[e-]");
  visit_detector(v, h);
  v.number("SATURATE", h.saturation_dn, "[DN] counts from here on may be clipped");
  for (const ImageParameter& p : image_parameters()) {
    double& number = h.image_optics.*p.value;
    if (v.present(std::string(p.keyword).c_str(), number != ImageOptics().*p.value))
      v.number(std::string(p.keyword), number, std::string(p.meaning).c_str());
  }
  v.number("PSFFWHM", h.psf_fwhm_px, "[px] Gaussian, before pixel integration");
  v.number("PHOTZP", h.zero_point_mag, "[mag] of 1 e-/s, without atmosphere");
  v.number("EXTINCT", h.extinction_mag_per_airmass, "[mag/airmass]");
  if (v.present("R0", h.r0_m > 0)) {
    v.number("R0", h.r0_m, "[m] Fried parameter, zenith, 500 nm");
    v.number("ISOPLAN", h.isoplanatic_angle_rad, "[rad] isoplanatic angle, likewise");
    v.number("TAU0", h.tau0_s, "[s] coherence time r0 / wind, likewise");
  }
  v.projection("PROJNAME", h.projection, "of the lens");
  v.number("FOCALPX", h.focal_length_px, "[px] focal length");
  constexpr const char* attitudes[3] = {"QBEG", "QAVG", "QEND"};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string key = attitudes[i];
    Quaternion& q = h.camera_from_gcrs[i];
    v.number(key + "0", q.w, "quaternion camera from GCRS, scalar first");
    v.number(key + "1", q.x, "");
    v.number(key + "2", q.y, "");
    v.number(key + "3", q.z, "");
  }
  visit_vector(v, "SENPOS", h.sensor_position_m, "[m] sensor, GCRS, mid exposure");
  visit_vector(v, "SENVEL", h.sensor_velocity_m_per_s, "[m/s] sensor, GCRS, mid exposure");
  visit_vector(v, "EARVEL", h.earth_velocity_m_per_s, "[m/s] Earth, barycentric, GCRS axes");
  if (v.present("OBSGEO-X", h.site.has_value())) {
    if (!h.site) h.site.emplace();
    visit_vector(v, "OBSGEO-", h.site->position_m, "[m] site, ITRS");
    v.angle("SITELAT", h.site->latitude_rad, "[deg] geodetic latitude");
    v.angle("SITELONG", h.site->longitude_rad, "[deg] longitude, east positive");
    v.number("SITEELEV", h.site->height_m, "[m] height above the ellipsoid");
  }
  if (v.present("PRESSURE", h.air.has_value())) {
    if (!h.air) h.air.emplace();
    v.number("PRESSURE", h.air->pressure_hpa,
             "[hPa] of the air that refracts, 0: refraction is off");
    v.number("AIRTEMP", h.air->temperature_c, "[deg C]");
    v.number("HUMIDITY", h.air->humidity, "relative, 0 to 1");
  }
  visit_wcs(v, h.projection, h.wcs);
  v.integer("SEED", h.seed, "of the random draws");
  v.text("SCENARIO", h.scenario_digest, "digest of the scenario");
  v.text("CREATOR", h.software, "");
}

void require_sense(const CardReader& v, const FrameHeader& h) {
  v.require(h.exposure_s > 0, "EXPTIME", "must be > 0");
  v.require(h.start <= h.middle && h.middle <= h.end, "SIMT-AVG", "must lie between start and end");
  v.require(h.gain_e_per_dn > 0, "GAIN", "must be > 0");
  v.require(h.read_noise_e >= 0, "RDNOISE", "must be >= 0");
  v.require(h.saturation_dn > 0, "SATURATE", "must be > 0");
  v.require(h.psf_fwhm_px > 0 && h.psf_fwhm_px <= 1e4, "PSFFWHM", "must be in (0, 1e4]");
  v.require(h.focal_length_px > 0, "FOCALPX", "must be > 0");
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
      if (card[at] == '\'' && (at + 1 >= card.size() || card[++at] != '\'')) break;
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
