#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/orbit/elements/catalogue.h"
#include "core/photometry/diffuse_sphere.h"

namespace dmise {

/// Known properties of an object that determine its brightness.
struct ObjectFacts {
  std::optional<double> standard_magnitude;  // V at 1000 km, half lit, the Sun at 1 au
  std::optional<double> rcs_m2;              // radar cross-section
  std::array<double, 3> dimensions_m{};  // length, width, height (0: unknown); one alone: diameter
  std::optional<double> albedo;          // Lambert reflectance, (0, 1]
};

struct ObjectFactsFile {
  std::string source;
  std::map<std::uint32_t, ObjectFacts> facts;  // by catalogue number
  std::vector<CatalogueProblem> refused;       // rows that were not read
};

/// Reads a CSV with a header: catalogue_number (or NORAD_CAT_ID), and any of standard_magnitude,
/// rcs_m2, length_m, width_m, height_m, albedo; other columns are ignored, blank fields are
/// unknown. The later of two rows of one object is refused. Throws `ConfigError` if there is no
/// column of numbers.
ObjectFactsFile read_object_facts(const std::string& path);
ObjectFactsFile parse_object_facts(std::string_view text, const std::string& source);

/// The property that a sphere was derived from, best first.
enum class BrightnessSource { standard_magnitude, dimensions, rcs, none };

struct ObjectSphere {
  DiffuseSphere sphere;
  BrightnessSource source = BrightnessSource::none;
};

/// Returns the equivalent sphere of an object: from its standard magnitude; else from its mean
/// cross-section (a quarter of the surface of its box or cylinder); else from its radar
/// cross-section, a crude substitute; else `unknown`.
ObjectSphere sphere_of(const ObjectFacts& facts, const DiffuseSphere& unknown = {});

}  // namespace dmise
