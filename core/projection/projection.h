#pragma once
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "core/projection/brown_conrady.h"
#include "core/projection/classical.h"
#include "core/projection/kannala_brandt.h"

namespace dmise {

/// Maps directions to image places, for lenses and for FITS world coordinate systems. Image places
/// are in focal lengths from the axis, which is +z.
///
/// A projection is a struct with its name, its FITS code (null if FITS has none: a frame's WCS is
/// then fitted on a gnomonic plane), its coefficients, the widest field that a camera may have and
/// the functions called below. To add one, write its file pair and list it in `Model`. The order is
/// that of `projection` in messages and digests: append only.
class Projection {
 public:
  using Model =
      std::variant<Gnomonic, Equidistant, Equisolid, Stereographic, KannalaBrandt, BrownConrady>;
  static const Projection gnomonic, equidistant, equisolid, stereographic;

  struct Row {
    const char *name, *fits_code;
    std::span<const ProjectionCoefficient> coefficients;
    double widest_field_rad;
  };
  /// The table of projections.
  static std::span<const Row> rows();
  /// Returns the index in the table; empty if no row has the name or code.
  static std::optional<std::size_t> index_of_name(std::string_view name);
  static std::optional<std::size_t> index_of_fits_code(std::string_view code);

  constexpr Projection() = default;
  constexpr Projection(const Model& model) : model_(model) {}
  /// Throws `Error` "KEY: reason, got VALUE" if the coefficients do not match the row.
  static Projection make(std::size_t index, std::span<const double> coefficients);

  std::size_t index() const { return model_.index(); }
  const Row& row() const { return rows()[index()]; }
  const char* name() const { return row().name; }
  std::span<const double> coefficients() const;
  /// The FITS projection on which a WCS of this lens is fitted.
  Projection fits_plane() const { return row().fits_code ? *this : gnomonic; }

  /// Image height at an angle from the axis; for a lens with tangential terms, the mean of both
  /// sides along x.
  double height(double theta_rad) const;
  /// Largest image height; infinite if there is no such limit.
  double rim() const;
  /// Angle from the axis at which the mapping folds back; empty if it never does.
  std::optional<double> fold_rad() const;
  /// Angle from the axis of an image place; empty where no direction is imaged.
  std::optional<double> axis_angle_rad(double x, double y) const;
  /// Unit vector of an image place; empty where no direction is imaged.
  std::optional<std::array<double, 3>> direction_of(double x, double y) const;
  /// Image place of a unit vector; empty if it has none.
  std::optional<std::array<double, 2>> image_of(double x, double y, double z) const;
  /// Solid angle of a pixel at (x_px, y_px) from the axis; 0 where no direction is imaged.
  double pixel_solid_angle_sr(double x_px, double y_px, double focal_length_px) const;

  bool operator==(const Projection&) const = default;

 private:
  Model model_;
};

inline const Projection Projection::gnomonic{Gnomonic{}};
inline const Projection Projection::equidistant{Equidistant{}};
inline const Projection Projection::equisolid{Equisolid{}};
inline const Projection Projection::stereographic{Stereographic{}};

}  // namespace dmise
