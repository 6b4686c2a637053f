#include "core/config/sensors/psf_file_config.h"

#include <cmath>
#include <cstdlib>

#include "core/base/error.h"
#include "core/base/files/digest.h"
#include "core/base/files/fits_guard.h"
#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/image/fits_image.h"

namespace dmise {
namespace {

constexpr int longest_side = 1024, max_planes = 512;
constexpr double max_values = 64e6;
constexpr double min_samples_per_px = 0.5, max_samples_per_px = 64.0;

/// A card's value where it is a positive number.
std::optional<double> positive(const FitsValues& cards, const std::string& key) {
  const auto found = cards.find(key);
  if (found == cards.end()) return std::nullopt;
  const double value = std::strtod(found->second.c_str(), nullptr);
  return std::isfinite(value) && value > 0.0 ? std::optional(value) : std::nullopt;
}

std::optional<double> stated_samples_per_px(const FitsValues& cards, const Optics& optics) {
  if (const auto samples = positive(cards, "OVERSAMP")) return samples;
  if (const auto px = positive(cards, "PSF_SAMP")) return 1.0 / *px;
  if (const auto scale = positive(cards, "PIXELSCL"))
    return optics.pixel_angle_rad() / (*scale * arcsec);
  return std::nullopt;
}

/// "(y, x)", as STPSF and photutils write places.
std::optional<PixelPosition> place_of(const FitsValues& cards, int plane) {
  const auto found = cards.find("DET_YX" + std::to_string(plane));
  if (found == cards.end()) return std::nullopt;
  std::string_view pair = trimmed(found->second);
  if (pair.starts_with('(') && pair.ends_with(')')) pair = pair.substr(1, pair.size() - 2);
  const std::size_t comma = pair.find(',');
  const auto y = parse_real(trimmed(pair.substr(0, comma)));
  const auto x = comma == pair.npos ? std::nullopt : parse_real(trimmed(pair.substr(comma + 1)));
  if (!x || !y)
    throw Error(formatted("DET_YX%d: must be (y, x), got %s", plane, found->second.c_str()));
  return PixelPosition{*x, *y};
}

/// [m], as POPPY writes them for the planes of a cube.
std::optional<double> wavelength_of(const FitsValues& cards, int plane) {
  if (const auto short_name = positive(cards, formatted("WAVELN%02d", plane))) return short_name;
  return positive(cards, formatted("WVLN%04d", plane));
}

std::vector<MeasuredPsf::Plane> planes_of(FitsImage& image) {
  std::vector<MeasuredPsf::Plane> planes(std::size_t(image.planes()));
  for (int i = 0; i < image.planes(); ++i) {
    auto& plane = planes[std::size_t(i)];
    if (image.planes() > 1) {
      plane.at = place_of(image.values(), i);
      plane.wavelength_m = wavelength_of(image.values(), i);
      if (!plane.at && !plane.wavelength_m)
        throw Error(formatted("plane %d of %d has neither DET_YX%d nor WAVELN%02d", i,
                              image.planes(), i, i));
    }
    image.add_plane(i, plane.values);
    for (std::size_t k = 0; k < plane.values.size(); ++k)
      if (!std::isfinite(plane.values[k]))
        throw Error(formatted("pixel (%d, %d) of plane %d has no value",
                              int(k % std::size_t(image.columns())) + 1,
                              int(k / std::size_t(image.columns())) + 1, i));
  }
  return planes;
}

/// `samples`: as the key states them.
std::shared_ptr<const MeasuredPsf> load(const std::string& file, std::optional<double> samples,
                                        bool with_pixel, const Optics& optics) {
  const std::string bytes = read_fits_file(file);
  FitsImage image(bytes, file);
  if (image.columns() > longest_side || image.rows() > longest_side ||
      image.planes() > max_planes ||
      double(image.columns()) * image.rows() * image.planes() > max_values)
    throw Error(formatted(
        "must be at most %d x %d and %d planes, %g values in all, got %d x %d x %d", longest_side,
        longest_side, max_planes, max_values, image.columns(), image.rows(), image.planes()));
  const auto per_px = samples ? samples : stated_samples_per_px(image.values(), optics);
  if (!per_px)
    throw Error("needs samples_per_px: the file has no card OVERSAMP, PSF_SAMP or PIXELSCL");
  if (*per_px < min_samples_per_px || *per_px > max_samples_per_px)
    throw Error(formatted("its header says %g samples a pixel; must be in %g..%g", *per_px,
                          min_samples_per_px, max_samples_per_px));
  const std::string digest =
      formatted("%s %.17g %d", sha256_hex(bytes).c_str(), *per_px, int(with_pixel));
  return std::make_shared<const MeasuredPsf>(image.columns(), image.rows(), *per_px, with_pixel,
                                             planes_of(image), digest);
}

/// Errors have the place of the key.
MeasuredPsfPointer load_at(const YamlValue& path, std::optional<double> samples, bool with_pixel,
                           const Optics& optics) {
  const std::string file = path.existing_file();
  try {
    return load(file, samples, with_pixel, optics);
  } catch (const ConfigError& error) {
    path.fail(error.what(), false);  // which names the file
  } catch (const Error& error) {
    path.fail(error.what());
  }
}

}  // namespace

const Section& psf_file_section() {
  static const Section section{
      "psf_file",
      "Images of a point source in a FITS file. The middle of an image is the place of the chief "
      "ray. Planes of a cube are of places of the frame (cards DET_YX0, ..: `(y, x)` in pixels), "
      "of wavelengths (WAVELN00, .. in metres), or of both.",
      {required("path", form::text(), "The file, beside this one."),
       optional("samples_per_px", form::number(min_samples_per_px, max_samples_per_px),
                "Pixels of an image in a pixel of the camera. Without it cards tell: OVERSAMP, "
                "PSF_SAMP (its inverse) or PIXELSCL [arcsec]."),
       optional("with_pixel", form::flag(),
                "The response of the camera's pixel is in the images, as in an effective point "
                "spread function (ePSF).",
                "off")}};
  return section;
}

MeasuredPsfPointer read_psf_file(const YamlValue& value, const Optics& optics) {
  if (value.is_scalar()) return load_at(value, std::nullopt, false, optics);
  YamlMap map(value, psf_file_section());
  const YamlValue path = map.require("path");
  const auto samples = map.find("samples_per_px");
  const bool with_pixel = map.flag("with_pixel");
  map.done();
  return load_at(path, samples ? std::optional(samples->number()) : std::nullopt, with_pixel,
                 optics);
}

}  // namespace dmise
