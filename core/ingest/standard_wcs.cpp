#include "core/ingest/standard_wcs.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
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

/// Number of the axis (1 or 2) of right ascension.
int right_ascension_axis(const StandardCards& cards) {
  const bool first = cards.text("CTYPE1").starts_with("RA--"),
             second = cards.text("CTYPE2").starts_with("RA--");
  if (first && cards.text("CTYPE2").starts_with("DEC-")) return 1;
  if (second && cards.text("CTYPE1").starts_with("DEC-")) return 2;
  throw Unknown{"CTYPE1", "pointing: must be RA or DEC beside the other"};
}

Projection projection_of(const StandardCards& cards, int ra_axis) {
  const std::string key = "CTYPE" + std::to_string(ra_axis), type = cards.text(key);
  const auto row = Projection::index_of_fits_code(
      std::string_view(type).substr(std::min<std::size_t>(5, type.size()), 3));
  if (!row) throw Unknown{key, "pointing: a projection that is not known"};
  const std::string pv = "PV" + std::to_string(3 - ra_axis) + "_";
  std::vector<double> coefficients;
  for (const auto& c : Projection::rows()[*row].coefficients)
    coefficients.push_back(cards.number(pv + std::to_string(c.pv)).value_or(0.0));
  if (!coefficients.empty() && cards.number(pv + "1").value_or(0.0) != 1.0)
    throw Unknown{pv + "1", "pointing: of a polynomial must be 1"};
  for (const std::string axis : {"PV1_", "PV2_"})
    for (int m = 0; m <= 39; ++m) {
      const std::string extra = axis + std::to_string(m);
      const auto& known = Projection::rows()[*row].coefficients;
      const bool used = !coefficients.empty() && axis == pv &&
                        (m == 1 || std::any_of(known.begin(), known.end(),
                                               [m](const auto& c) { return c.pv == m; }));
      if (!used && cards.number(extra).value_or(0.0) != 0.0)
        throw Unknown{extra, "pointing: a term that is not known"};
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

/// Rows for right ascension and declination, turned to LONPOLE = 180 deg.
void set_matrix(const StandardCards& cards, int ra_axis, Wcs& wcs) {
  wcs.cd_deg = matrix_of(cards);
  for (std::size_t i = 0; i < 4; ++i)
    wcs.cd_deg[i] *= degrees_of_unit(cards, i < 2 ? "CUNIT1" : "CUNIT2");
  if (ra_axis == 2) wcs.cd_deg = {wcs.cd_deg[2], wcs.cd_deg[3], wcs.cd_deg[0], wcs.cd_deg[1]};
  const double otherwise = wcs.dec_rad >= 90 * deg ? 0.0 : 180.0;
  const double turn = (180 - cards.number("LONPOLE").value_or(otherwise)) * deg;
  const double c = std::cos(turn), s = std::sin(turn);
  const auto m = wcs.cd_deg;
  if (turn != 0)
    wcs.cd_deg = {c * m[0] - s * m[2], c * m[1] - s * m[3], s * m[0] + c * m[2],
                  s * m[1] + c * m[3]};
  const double area = std::abs(wcs.cd_deg[0] * wcs.cd_deg[3] - wcs.cd_deg[1] * wcs.cd_deg[2]);
  if (!(area > 1e-16 && area < 1e4))
    throw Unknown{"CD1_1", "pointing: the matrix has no inverse or no scale of a camera"};
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

void require_icrs(const StandardCards& cards) {
  const auto frame = cards.first_text({"RADESYS", "RADECSYS"});
  const double equinox = cards.number("EQUINOX").value_or(2000.0);
  const bool fk5 = frame ? frame->value == "FK5" : cards.has("EQUINOX");
  if (frame && frame->value != "ICRS" && frame->value != "FK5")
    throw Unknown{frame->key, "pointing: must be ICRS or FK5"};
  if (fk5 && equinox != 2000.0) throw Unknown{"EQUINOX", "pointing: must be 2000"};
}

Wcs read_wcs(const StandardCards& cards) {
  Wcs wcs;
  const int ra_axis = right_ascension_axis(cards);
  const std::string ra = std::to_string(ra_axis), dec = std::to_string(3 - ra_axis);
  require_icrs(cards);
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
  } catch (const Error& e) {  // of a projection's coefficients
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
