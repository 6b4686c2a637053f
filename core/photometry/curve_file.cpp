#include "core/photometry/curve_file.h"

#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/units.h"

namespace dmise {
namespace {

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> found;
  constexpr std::string_view between = ", \t\r;";
  std::size_t at = 0;
  while ((at = line.find_first_not_of(between, at)) != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(between, at), line.size());
    found.push_back(line.substr(at, end - at));
    at = end;
  }
  return found;
}

std::optional<double> metres_of(std::string_view column) {
  if (column == "wavelength_nm") return nm;
  if (column == "wavelength_um") return um;
  if (column == "wavelength_m") return 1.0;
  if (column == "wavelength_angstrom") return 1e-10;
  return std::nullopt;
}

}  // namespace

Curve parse_curve(std::string_view text, const std::string& name) {
  Curve curve;
  double unit_m = 0.0, scale = 1.0;
  LineReader lines(text);
  const auto fail = [&](const std::string& reason, std::string_view field) {
    throw ConfigError(at_line(name, lines.line(), reason + ", got " + std::string(field)));
  };
  while (const auto line = lines.next()) {
    const auto fields = words(line->substr(0, line->find('#')));
    if (fields.empty()) continue;
    if (fields.size() < 2) fail("needs a wavelength and a value", fields[0]);
    if (unit_m == 0.0) {
      const auto unit = metres_of(fields[0]);
      if (!unit) fail("the first column must be wavelength_nm, _um, _m or _angstrom", fields[0]);
      unit_m = *unit;
      if (fields[1].ends_with("_percent")) scale = 0.01;
      continue;
    }
    const auto wavelength = parse_real(fields[0]), value = parse_real(fields[1]);
    if (!wavelength || !(*wavelength > 0)) fail("wavelength must be a number > 0", fields[0]);
    if (!value || *value * scale < 0 || *value * scale > 1)
      fail(scale == 1.0 ? "value must be in [0, 1]" : "value must be in [0, 100]", fields[1]);
    const double at_m = *wavelength * unit_m;
    if (!curve.empty() && at_m <= curve.wavelength_m.back())
      fail("wavelengths must ascend", fields[0]);
    curve.add(at_m, *value * scale);
  }
  if (curve.wavelength_m.size() < 2)
    throw ConfigError(name + ": a curve needs a header and two lines or more");
  return curve;
}

}  // namespace dmise
