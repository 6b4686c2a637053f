#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/pixel.h"
#include "core/optics/waves/psf_kernel.h"

namespace dmise {

/// Images of a point source that were measured or computed elsewhere, at places of a grid over the
/// frame and at wavelengths. Between them they are interpolated linearly; beyond the outermost the
/// outermost holds. The middle of an image is the place of the chief ray: centroids are kept.
class MeasuredPsf {
 public:
  /// One image, rows x columns; its sum must be above 0.
  struct Plane {
    std::optional<PixelPosition> at;     // place in the frame; none: all places
    std::optional<double> wavelength_m;  // none: all
    std::vector<double> values;
  };

  /// Throws `Error` "reason, got value" unless the planes are one for each combination of the
  /// columns and rows of a grid and of the wavelengths.
  MeasuredPsf(int columns, int rows, double samples_per_px, bool with_pixel,
              std::vector<Plane> planes, std::string digest);

  double samples_per_px() const { return samples_per_px_; }
  /// Whether the response of a square pixel is in the images, as in an effective point spread.
  bool with_pixel() const { return with_pixel_; }
  int grid_columns() const { return int(x_px_.size()); }
  int grid_rows() const { return int(y_px_.size()); }
  int wavelengths() const { return int(wavelengths_m_.size()); }
  /// From the middle to the farther edge [px].
  double reach_px() const;
  /// Diameter of the disc of the area above half of the maximum, of the middle of the frame and of
  /// the wavelengths [px].
  double fwhm_px() const { return fwhm_px_; }
  /// Frequency above which less than 0.03 % of the light's amplitude is [cycles/px].
  double cutoff_per_px() const { return cutoff_per_px_; }
  const std::string& digest() const { return digest_; }

  /// Kernel of a place of the frame and a wavelength on cells, `cells_per_px` a pixel: by the
  /// transform of the images, without frequencies beyond half a cycle a sample or a cell, times
  /// `more`, a real transfer function of frequencies [cycles/px]. Over the outermost `margin_cells`
  /// it tapers off. Sums to 1.
  PsfKernel kernel(PixelPosition at, double wavelength_m, int cells_per_px, int half_cells,
                   const TransferFunction& more) const;
  static constexpr int margin_cells = 4;  // wanted beyond the image, for what `more` spreads

 private:
  std::vector<double> image_at(PixelPosition at, double wavelength_m) const;
  void measure();
  double cutoff_of(const std::vector<double>& image) const;

  int columns_, rows_;
  double samples_per_px_;
  bool with_pixel_;
  std::vector<double> x_px_, y_px_, wavelengths_m_;
  std::vector<std::vector<double>> images_;  // by wavelength, then row, then column; sum 1
  std::string digest_;
  double fwhm_px_ = 0.0, cutoff_per_px_ = 0.0;
};

/// Shared by the sensors that have it; equal if the files are.
struct MeasuredPsfPointer : std::shared_ptr<const MeasuredPsf> {
  MeasuredPsfPointer(std::shared_ptr<const MeasuredPsf> psf = nullptr)
      : shared_ptr(std::move(psf)) {}
  bool operator==(const MeasuredPsfPointer& other) const {
    return (get() ? get()->digest() : "") == (other.get() ? other.get()->digest() : "");
  }
};

}  // namespace dmise
