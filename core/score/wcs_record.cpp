#include "core/score/wcs_record.h"

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

Projection projection_of(const JsonRecord& record, const char* key, std::size_t index) {
  std::vector<double> coefficients;
  for (const ProjectionCoefficient& c : Projection::rows()[index].coefficients)
    coefficients.push_back(record.number(c.key));
  try {
    return Projection::make(index, coefficients);
  } catch (const Error& error) {
    record.fail(key, error.what());
  }
}

std::vector<std::string> names_of(const char* Projection::Row::*kind) {
  std::vector<std::string> names;
  for (const Projection::Row& row : Projection::rows())
    if (row.*kind) names.emplace_back(row.*kind);
  return names;
}

std::vector<double> polynomial(const JsonRecord& record, const char* key, int order) {
  std::vector<double> c = record.number_list(key);
  const auto side = std::size_t(order + 1);
  if (c.size() != side * side)
    record.fail(key, "must have " + std::to_string(side * side) + " numbers");
  return c;
}

WcsRefraction refraction_of(const JsonRecord& record) {
  const auto zenith = record.numbers<3>("zenith");
  const auto offset = record.numbers<2>("offset_px");
  WcsRefraction air{.zenith = {zenith[0], zenith[1], zenith[2]},
                    .focal_length_px = record.number("focal_length_px"),
                    .lens = {},
                    .pressure_hpa = record.number("pressure_hpa"),
                    .temperature_c = record.number("temperature_c"),
                    .humidity = record.number("humidity"),
                    .wavelength_um = record.number("wavelength_um"),
                    .offset_x_px = offset[0],
                    .offset_y_px = offset[1],
                    .cell_px = record.number("cell_px")};
  if (!(air.focal_length_px > 0.0)) record.fail("focal_length_px", "must be > 0");
  if (record.has("lens")) {
    const std::string name = record.get<std::string>("lens");
    const auto index = Projection::index_of_name(name);
    if (!index) record.fail_as_none_of(names_of(&Projection::Row::name), "lens", name);
    air.lens = projection_of(record, "lens", *index);
  }
  return air;
}

}  // namespace

Wcs wcs_of(const JsonRecord& record) {
  std::string code = record.get<std::string>("projection");
  if (code.ends_with("-SIP")) code.resize(code.size() - 4);
  const auto index = Projection::index_of_fits_code(code);
  if (!index) record.fail_as_none_of(names_of(&Projection::Row::fits_code), "projection", code);
  const auto reference = record.numbers<2>("crpix_px");
  const auto direction = record.numbers<2>("crval_deg");
  Wcs wcs{.projection = projection_of(record, "projection", *index),
          .crpix_x = reference[0],
          .crpix_y = reference[1],
          .ra_rad = direction[0] * deg,
          .dec_rad = direction[1] * deg,
          .cd_deg = record.numbers<4>("cd_deg_per_px"),
          .order = record.get<int>("order")};
  if (wcs.order < 0 || wcs.order > 9) record.fail("order", "must be 0 to 9");
  if (wcs.order > 0) {
    wcs.a = polynomial(record, "a", wcs.order);
    wcs.b = polynomial(record, "b", wcs.order);
    wcs.ap = polynomial(record, "ap", wcs.order);
    wcs.bp = polynomial(record, "bp", wcs.order);
  }
  if (wcs.cd_deg[0] * wcs.cd_deg[3] == wcs.cd_deg[1] * wcs.cd_deg[2])
    record.fail("cd_deg_per_px", "has no inverse");
  if (record.has("refraction")) wcs.refraction = refraction_of(record.object("refraction"));
  wcs.rms_px = record.number("rms_px");
  wcs.max_px = record.number("max_px");
  return wcs;
}

}  // namespace dmise
