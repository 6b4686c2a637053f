#include "core/ingest/standard_wcs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/frames/celestial_frames.h"
#include "core/image/card_text.h"

namespace dmise {
namespace {

/// Thrown where a WCS is not one that is known.
struct Unknown {
  std::string key, reason;
};

double required(const StandardCards& cards, const std::string& key) {
  const auto value = cards.number(key);
  if (!value) throw Unknown{key, "pointing: is missing or no number"};
  return *value;
}

/// Number of the axis (1 or 2) of right ascension, or of the galactic longitude.
int longitude_axis(const StandardCards& cards) {
  const std::string first = cards.text("CTYPE1").substr(0, 4),
                    second = cards.text("CTYPE2").substr(0, 4);
  for (const auto& [longitude, latitude] : {std::pair{"RA--", "DEC-"}, {"GLON", "GLAT"}}) {
    if (first == longitude && second == latitude) return 1;
    if (first == latitude && second == longitude) return 2;
  }
  throw Unknown{"CTYPE1", "pointing: must be RA or DEC beside the other"};
}

constexpr int max_pv = 39;

std::string pv_key(int axis, int number) {
  return "PV" + std::to_string(axis) + "_" + std::to_string(number);
}

/// Whether the plane of the sky is bent by TPV's polynomials. Some programs write TAN for them; its
/// own parameters are PV1_0 to PV1_4 alone.
bool has_tpv(const StandardCards& cards, const std::string& code, int ra_axis) {
  if (code != "TAN") return code == "TPV";
  for (int m = 0; m <= max_pv; ++m)
    if (cards.has(pv_key(3 - ra_axis, m)) || (m > 4 && cards.has(pv_key(ra_axis, m)))) return true;
  return false;
}

std::string projection_code(const StandardCards& cards, int ra_axis) {
  const std::string type = cards.text("CTYPE" + std::to_string(ra_axis));
  return type.substr(std::min<std::size_t>(5, type.size()), 3);
}

Projection projection_of(const StandardCards& cards, int ra_axis) {
  const std::string key = "CTYPE" + std::to_string(ra_axis);
  const std::string code = projection_code(cards, ra_axis);
  if (has_tpv(cards, code, ra_axis)) return Projection::gnomonic;
  const auto row = Projection::index_of_fits_code(code);
  if (!row) throw Unknown{key, "pointing: a projection that is not known"};
  const std::string pv = "PV" + std::to_string(3 - ra_axis) + "_";
  std::vector<double> coefficients;
  for (const auto& c : Projection::rows()[*row].coefficients)
    coefficients.push_back(cards.number(pv + std::to_string(c.pv)).value_or(0.0));
  if (!coefficients.empty() && cards.number(pv + "1").value_or(0.0) != 1.0)
    throw Unknown{pv + "1", "pointing: of a polynomial must be 1"};
  for (const int axis : {1, 2})
    for (int m = 0; m <= max_pv; ++m) {
      const auto& known = Projection::rows()[*row].coefficients;
      const bool used = !coefficients.empty() && axis == 3 - ra_axis &&
                        (m == 1 || std::any_of(known.begin(), known.end(),
                                               [m](const auto& c) { return c.pv == m; }));
      if (!used && cards.number(pv_key(axis, m)).value_or(0.0) != 0.0)
        throw Unknown{pv_key(axis, m), "pointing: a term that is not known"};
    }
  return Projection::make(*row, coefficients);
}

/// Degrees per pixel by axis of the header: CDi_j, else CDELTi PCi_j, else CDELTi and CROTA2.
std::array<double, 4> matrix_of(const StandardCards& cards) {
  std::array<double, 4> m{};
  const char* keys[4] = {"1_1", "1_2", "2_1", "2_2"};
  const auto any = [&](const char* family) {
    return std::any_of(keys, keys + 4,
                       [&](const char* key) { return cards.has(std::string(family) + key); });
  };
  if (any("CD")) {
    for (std::size_t i = 0; i < 4; ++i)
      m[i] = cards.number(std::string("CD") + keys[i]).value_or(0.0);
    return m;
  }
  const double x = required(cards, "CDELT1"), y = required(cards, "CDELT2");
  if (!any("PC") && cards.has("CROTA2")) {
    const double turn = required(cards, "CROTA2") * deg;
    return {x * std::cos(turn), -y * std::sin(turn), x * std::sin(turn), y * std::cos(turn)};
  }
  constexpr double unit[4] = {1, 0, 0, 1};
  for (std::size_t i = 0; i < 4; ++i)
    m[i] = (i < 2 ? x : y) * cards.number(std::string("PC") + keys[i]).value_or(unit[i]);
  return m;
}

double degrees_of_unit(const StandardCards& cards, const std::string& key) {
  const std::string unit = cards.text(key);
  if (unit.empty() || unit.starts_with("deg")) return 1.0;
  if (unit == "arcsec") return 1.0 / 3600;
  if (unit == "arcmin") return 1.0 / 60;
  if (unit == "rad") return 1.0 / deg;
  throw Unknown{key, "pointing: a unit that is not known"};
}

/// Rows for right ascension and declination.
void set_matrix(const StandardCards& cards, int ra_axis, Wcs& wcs) {
  wcs.cd_deg = matrix_of(cards);
  for (std::size_t i = 0; i < 4; ++i)
    wcs.cd_deg[i] *= degrees_of_unit(cards, i < 2 ? "CUNIT1" : "CUNIT2");
  if (ra_axis == 2) wcs.cd_deg = {wcs.cd_deg[2], wcs.cd_deg[3], wcs.cd_deg[0], wcs.cd_deg[1]};
  const double area = std::abs(wcs.cd_deg[0] * wcs.cd_deg[3] - wcs.cd_deg[1] * wcs.cd_deg[2]);
  if (!(area > 1e-16 && area < 1e4))
    throw Unknown{"CD1_1", "pointing: the matrix has no inverse or no scale of a camera"};
}

/// Turns the plane of the sky.
void turn_matrix(double sine, double cosine, Wcs& wcs) {
  const auto m = wcs.cd_deg;
  wcs.cd_deg = {cosine * m[0] - sine * m[2], cosine * m[1] - sine * m[3],
                sine * m[0] + cosine * m[2], sine * m[1] + cosine * m[3]};
}

void turn_to_lonpole(const StandardCards& cards, Wcs& wcs) {
  const double otherwise = wcs.dec_rad >= 90 * deg ? 0.0 : 180.0;
  const double turn = (180 - cards.number("LONPOLE").value_or(otherwise)) * deg;
  if (turn != 0) turn_matrix(std::sin(turn), std::cos(turn), wcs);
}

std::vector<double> sip_terms(const StandardCards& cards, const std::string& name, int order) {
  if (!cards.has(name + "_ORDER")) return {};
  const auto side = std::size_t(order) + 1;
  std::vector<double> terms(side * side, 0.0);
  for (std::size_t p = 0; p < side; ++p)
    for (std::size_t q = 0; p + q < side; ++q)
      terms[p * side + q] =
          cards.number(name + "_" + std::to_string(p) + "_" + std::to_string(q)).value_or(0.0);
  return terms;
}

void set_sip(const StandardCards& cards, Wcs& wcs) {
  for (const std::string name : {"A", "B", "AP", "BP"}) {
    const double order = cards.number(name + "_ORDER").value_or(0.0);
    if (!(order >= 0 && order <= highest_sip_order && order == std::floor(order)))
      throw Unknown{name + "_ORDER", "pointing: must be in 0..9"};
    wcs.order = std::max(wcs.order, int(order));
  }
  wcs.a = sip_terms(cards, "A", wcs.order);
  wcs.b = sip_terms(cards, "B", wcs.order);
  wcs.ap = sip_terms(cards, "AP", wcs.order);
  wcs.bp = sip_terms(cards, "BP", wcs.order);
}

/// A polynomial in two variables, index p * side + q.
class PolynomialOfTwo {
 public:
  static constexpr int order = 7;  // TPV has no higher one
  static constexpr std::size_t side = std::size_t(order) + 1;

  static PolynomialOfTwo linear(double by_u, double by_v) {
    PolynomialOfTwo p;
    p.c_[side] = by_u;
    p.c_[1] = by_v;
    return p;
  }
  static PolynomialOfTwo constant(double value) {
    PolynomialOfTwo p;
    p.c_[0] = value;
    return p;
  }
  /// Terms above the order are zero: those of TPV have none.
  PolynomialOfTwo operator*(const PolynomialOfTwo& b) const {
    PolynomialOfTwo product;
    for (std::size_t p = 0; p < side; ++p)
      for (std::size_t q = 0; p + q < side; ++q)
        for (std::size_t r = 0; p + q + r < side; ++r)
          for (std::size_t s = 0; p + q + r + s < side; ++s)
            product.c_[(p + r) * side + q + s] += c_[p * side + q] * b.c_[r * side + s];
    return product;
  }
  void add(const PolynomialOfTwo& b, double times) {
    for (std::size_t i = 0; i < c_.size(); ++i) c_[i] += times * b.c_[i];
  }
  double& at(std::size_t p, std::size_t q) { return c_[p * side + q]; }
  std::vector<double> terms() const { return {c_.begin(), c_.end()}; }

 private:
  std::array<double, side * side> c_{};
};

/// One of TPV's polynomials of the plane's coordinates `x` along its own axis and `y`.
PolynomialOfTwo tpv_polynomial(const StandardCards& cards, int axis, const PolynomialOfTwo& x,
                               const PolynomialOfTwo& y) {
  std::array<PolynomialOfTwo, PolynomialOfTwo::side> of_x, of_y;
  of_x[0] = of_y[0] = PolynomialOfTwo::constant(1.0);
  for (std::size_t i = 1; i < of_x.size(); ++i) {
    of_x[i] = of_x[i - 1] * x;
    of_y[i] = of_y[i - 1] * y;
  }
  PolynomialOfTwo sum;
  int number = 0;
  for (int order = 0; order <= PolynomialOfTwo::order; ++order) {
    for (int q = 0; q <= order; ++q, ++number) {
      const double otherwise = number == 1 ? 1.0 : 0.0;
      const double value = cards.number(pv_key(axis, number)).value_or(otherwise);
      if (value != 0.0) sum.add(of_x[std::size_t(order - q)] * of_y[std::size_t(q)], value);
    }
    if (order % 2 == 0) continue;
    if (cards.number(pv_key(axis, number)).value_or(0.0) != 0.0)
      throw Unknown{pv_key(axis, number), "pointing: a term in the distance is not known"};
    ++number;
  }
  return sum;
}

/// TPV bends the plane of the sky, SIP that of the pixels: the same polynomials, seen from there.
void set_tpv(const StandardCards& cards, int ra_axis, Wcs& wcs) {
  const std::string code = projection_code(cards, ra_axis);
  if (!has_tpv(cards, code, ra_axis)) return;
  if (code == "TAN") cards.assumed("pointing: TAN with PV terms is taken for TPV");
  if (wcs.order > 0) throw Unknown{"A_ORDER", "pointing: SIP beside TPV is not known"};
  const auto xi = PolynomialOfTwo::linear(wcs.cd_deg[0], wcs.cd_deg[1]),
             eta = PolynomialOfTwo::linear(wcs.cd_deg[2], wcs.cd_deg[3]);
  PolynomialOfTwo east = tpv_polynomial(cards, ra_axis, xi, eta),
                  north = tpv_polynomial(cards, 3 - ra_axis, eta, xi);
  wcs.cd_deg = {east.at(1, 0), east.at(0, 1), north.at(1, 0), north.at(0, 1)};
  const auto& m = wcs.cd_deg;
  const double det = m[0] * m[3] - m[1] * m[2];
  if (!(std::abs(det) > 1e-16))
    throw Unknown{pv_key(ra_axis, 1), "pointing: the polynomials have no inverse"};
  PolynomialOfTwo a, b;
  a.add(east, m[3] / det);
  a.add(north, -m[1] / det);
  b.add(north, m[0] / det);
  b.add(east, -m[2] / det);
  for (PolynomialOfTwo* one : {&a, &b}) one->at(1, 0) = one->at(0, 1) = 0.0;  // in the matrix
  wcs.order = PolynomialOfTwo::order;
  wcs.a = a.terms();
  wcs.b = b.terms();
}

/// How directions of a header's frame are turned to ICRS; empty: they are there already.
using ToIcrs = std::function<Vec<Gcrs>(double longitude_rad, double latitude_rad)>;

/// FITS Standard 4.0, section 8.3. EPOCH is the old name of EQUINOX.
ToIcrs to_icrs(const StandardCards& cards) {
  if (cards.text("CTYPE1").starts_with("GL")) return icrs_of_galactic;
  const auto frame = cards.first_text({"RADESYS", "RADECSYS"});
  const auto equinox = cards.first_number({"EQUINOX", "EPOCH"});
  std::string name = frame ? upper_case(frame->value) : "";
  if (name.empty() && !equinox) return {};
  if (name.empty()) name = equinox->value < 1984.0 ? "FK4" : "FK5";
  if (name == "J2000") name = "FK5";
  if (name == "ICRS" || name == "GCRS") return {};
  if (name != "FK4" && name != "FK5")
    throw Unknown{frame->key, "pointing: must be ICRS, FK5 or FK4"};
  const double year = equinox ? equinox->value : name == "FK4" ? 1950.0 : 2000.0;
  if (!(year >= 1800 && year <= 2200))
    throw Unknown{equinox->key, "pointing: must be in 1800..2200"};
  if (name == "FK4" || year != 2000.0)
    cards.assumed(formatted("pointing: turned from %s of %.6g to ICRS", name.c_str(), year));
  return [year, fk4 = name == "FK4"](double ra_rad, double dec_rad) {
    return fk4 ? icrs_of_fk4(ra_rad, dec_rad, year) : icrs_of_fk5(ra_rad, dec_rad, year);
  };
}

/// Turns the reference and its north to ICRS. The difference of frames is a rotation to 0.01 arcsec
/// in a field of 5 deg (the E-terms of FK4 differ over it).
void turn_to_icrs(const ToIcrs& convert, Wcs& wcs) {
  constexpr double step_rad = 0.1 * deg;
  if (!convert) return;
  const auto from = from_spherical<Gcrs>(wcs.ra_rad, wcs.dec_rad);
  const Vec<Gcrs> pole_wards{-std::cos(wcs.ra_rad) * std::sin(wcs.dec_rad),
                             -std::sin(wcs.ra_rad) * std::sin(wcs.dec_rad), std::cos(wcs.dec_rad)};
  const auto turned = [&](const Vec<Gcrs>& v) {
    const auto [longitude, latitude] = to_spherical(v);
    return convert(longitude, latitude);
  };
  const Vec<Gcrs> at = turned(from);
  const Vec<Gcrs> by = turned(from + pole_wards * step_rad) - turned(from - pole_wards * step_rad);
  const Vec<Gcrs> north_was = unit(by - at * dot(by, at));
  const auto [ra, dec] = to_spherical(at);
  wcs.ra_rad = ra;
  wcs.dec_rad = dec;
  const Vec<Gcrs> east{-std::sin(ra), std::cos(ra), 0.0}, north = cross(at, east);
  turn_matrix(-dot(north_was, east), dot(north_was, north), wcs);
}

Wcs read_wcs(const StandardCards& cards) {
  Wcs wcs;
  const int ra_axis = longitude_axis(cards);
  const std::string ra = std::to_string(ra_axis), dec = std::to_string(3 - ra_axis);
  const ToIcrs frame = to_icrs(cards);
  wcs.projection = projection_of(cards, ra_axis);
  wcs.crpix_x = required(cards, "CRPIX1") - 1;
  wcs.crpix_y = required(cards, "CRPIX2") - 1;
  wcs.ra_rad = required(cards, "CRVAL" + ra) * degrees_of_unit(cards, "CUNIT" + ra) * deg;
  wcs.dec_rad = required(cards, "CRVAL" + dec) * degrees_of_unit(cards, "CUNIT" + dec) * deg;
  if (!(std::abs(wcs.dec_rad) <= 90.000001 * deg))
    throw Unknown{"CRVAL" + dec, "pointing: must be in -90..90 deg"};
  if (!(std::abs(wcs.crpix_x) < 1e7 && std::abs(wcs.crpix_y) < 1e7))
    throw Unknown{"CRPIX1", "pointing: is not near the image"};
  if (!(std::abs(wcs.ra_rad) < 1e3)) throw Unknown{"CRVAL" + ra, "pointing: must be an angle"};
  set_matrix(cards, ra_axis, wcs);
  set_sip(cards, wcs);
  set_tpv(cards, ra_axis, wcs);
  turn_to_lonpole(cards, wcs);
  turn_to_icrs(frame, wcs);
  for (const char* key : {"CPDIS1", "CPDIS2", "D2IMDIS1", "D2IMDIS2", "CQDIS1", "CQDIS2"})
    if (cards.has(key)) throw Unknown{key, "pointing: a distortion by table is not known"};
  return wcs;
}

}  // namespace

std::optional<Wcs> wcs_of(const StandardCards& cards) {
  if (!cards.has("CTYPE1") && !cards.has("CTYPE2")) {
    cards.missing("pointing: no CTYPE1 and CTYPE2: no directions; dmise solve finds them");
    return std::nullopt;
  }
  try {
    return read_wcs(cards);
  } catch (const Unknown& u) {
    cards.reject(u.key, u.reason);
  } catch (const Error& e) {  // a projection's coefficients are wrong
    cards.reject("CTYPE1", std::string("pointing: ") + e.what());
  }
  return std::nullopt;
}

std::optional<CameraView> view_of(const Wcs& wcs, int columns, int rows) {
  const PixelPosition middle{(columns - 1) / 2.0, (rows - 1) / 2.0};
  const Vec<Gcrs> z = wcs_direction(wcs, middle);
  const auto slope = [&](const PixelPosition& half) {
    const Vec<Gcrs> d = wcs_direction(wcs, middle + half) - wcs_direction(wcs, middle - half);
    return d - z * dot(d, z);
  };
  const Vec<Gcrs> right = slope({0.5, 0}), down = slope({0, 0.5});
  const double area = dot(cross(right, down), z);
  if (!(std::abs(area) > 1 / (longest_focal_px * longest_focal_px))) return std::nullopt;
  CameraView view{.mirrored = area < 0, .focal_length_px = 1 / std::sqrt(std::abs(area))};
  const Vec<Gcrs> by_down = cross(unit(down), z) * (view.mirrored ? -1.0 : 1.0);
  const Vec<Gcrs> x = unit(unit(right) + by_down), y = cross(z, x);
  view.camera_from_gcrs.m = {{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
  return view;
}

}  // namespace dmise
