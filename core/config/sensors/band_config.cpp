#include "core/config/sensors/band_config.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/config/yaml/search_path.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/photometry/curve_file.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

constexpr std::size_t max_bytes = 4u << 20;
constexpr double narrowest_m = 1e-18;  // least width of a box, whose ends still differ

Curve curve_beside(const YamlValue& value) {
  const std::string path = value.existing_file();
  return parse_curve(read_text_file(path, max_bytes), path);
}

Band read_filter(const YamlValue& value) {
  const std::string name = value.text();
  if (auto band = filter_named(name)) return *band;
  if (!find_beside(name, value.file()).empty()) {
    const std::size_t slash = name.find_last_of('/');
    std::string stem = name.substr(slash == std::string::npos ? 0 : slash + 1);
    stem.resize(std::min(stem.find_last_of('.'), stem.size()));
    try {
      return band_of(std::move(stem), curve_beside(value));
    } catch (const ConfigError&) {
      throw;
    } catch (const Error& e) {
      value.fail(e.what());
    }
  }
  value.fail("no such filter" + did_you_mean(name, filter_names()) +
             " (a path to a CSV file, or one of " + joined(filter_names()) + ")");
}

const Section& band_section() {
  static const Section section{
      "band",
      "The band of the camera: a filter, or a box of given centre and width.",
      {optional("filter", form::text(filter_names()),
                "A filter (`dmise list filters`), or a CSV file of its transmission."),
       optional("name", form::text(), "Name of the band in products. By default the filter's."),
       optional("centre_m", form::number(0.1e-6, 30e-6),
                "Middle of the box [m]; needed without a filter."),
       optional("width_m", form::number(narrowest_m, 60e-6),
                "Width of the box [m], at most twice its centre; needed without a filter.")}};
  return section;
}

/// Refuses a band that reaches beyond the spectra of the sources.
void check_spectrum(const YamlValue& value, const Band& band) {
  const auto& at = sunlight_spectrum().irradiance.wavelength_m;
  if (band.low_m() >= at.front() && band.high_m() <= at.back()) return;
  value.fail(formatted("a band must lie within %g to %g um, the spectra of the sources, got %g to "
                       "%g um",
                       at.front() * 1e6, at.back() * 1e6, band.low_m() * 1e6, band.high_m() * 1e6),
             false);
}

}  // namespace

Forms band_forms() { return form::text(filter_names()) | form::map(band_section); }

Band read_band(const YamlValue& value) {
  if (value.is_scalar()) {
    Band band = read_filter(value);
    check_spectrum(value, band);
    return band;
  }
  YamlMap map(value, band_section());
  if (const auto filter = map.find("filter")) {
    Band band = read_filter(*filter);
    if (const auto name = map.find("name")) band.name = name->text();
    map.done();
    check_spectrum(*filter, band);
    return band;
  }
  Band band;
  const auto name = map.find("name");
  band.name = name ? name->text() : "V";
  band.centre_m = map.number("centre_m");
  band.width_m = map.number("width_m", Bounds::between(narrowest_m, 2 * band.centre_m));
  map.done();
  check_spectrum(value, band);
  return band;
}

QuantumEfficiency read_quantum_efficiency(const YamlValue& value) {
  const std::string text = value.is_scalar() ? value.text() : "";
  const bool is_number = text.find_first_not_of("+-.0123456789eE") == std::string::npos;
  if (is_number) return {.peak = value.number(Bounds::above(0.0, 1.0)), .relative = {}};
  QuantumEfficiency efficiency{.relative = curve_beside(value)};
  auto& values = efficiency.relative.value;
  efficiency.peak = *std::max_element(values.begin(), values.end());
  if (!(efficiency.peak > 0)) value.fail("the curve transmits no light");
  for (double& v : values) v /= efficiency.peak;
  return efficiency;
}

}  // namespace dmise
