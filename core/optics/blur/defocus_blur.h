#pragma once
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "core/base/image.h"
#include "core/optics/blur/blur_grid.h"
#include "core/optics/psf_model.h"

namespace dmise {

/// Light of sources that are out of focus, each with the kernel of its own defocus: transformed in
/// square tiles about its path, so that memory and time are of the light, not of the frame. Where
/// the blur changes over the field, a kernel is that of the nearest of 9 x 9 places. Accurate as
/// `BlurGrid` is, to the brightest cell of a tile.
class DefocusBlur {
 public:
  /// `in_focus`: the model of what is in focus, which must outlive this; null: its light is
  /// deposited. Light in a border of the frame, `border_px` wide, is not in it.
  DefocusBlur(const Optics& optics, const PsfPlan& in_focus_plan, const PsfModel* in_focus,
              int border_px);

  /// Starts an exposure.
  void begin(double start_s, double exposure_s);

  /// Adds arcs (in pixels) to the frame and returns what of their blurred light is inside.
  Deposited deposit(std::span<const Arc> arcs, double defocus_m, ExpectedElectronImage& light,
                    Threads& threads);

  /// How far from its place the light of a source may be.
  int reach_px(double defocus_m) const;

 private:
  struct Kernel {
    PsfPlan plan;
    PsfKernel kernel;
  };
  using Key = std::tuple<double, double, double>;  // defocus and place

  PsfPlan plan_of(double defocus_m) const;
  FieldPlace place_near(PixelPosition at) const;
  void take_kernel(double defocus_m, const FieldPlace& place, Threads& threads);
  Deposited add_tile(std::span<const Arc> arcs, int left, int top, ArcExtent part,
                     ExpectedElectronImage& light, Threads& threads);

  Optics optics_;
  PsfPlan in_focus_plan_;
  std::unique_ptr<PsfModel> own_;  // where light in focus is deposited
  const PsfModel* in_focus_;
  int border_px_;
  PsfTable table_;
  double start_s_ = 0.0, exposure_s_ = 0.0;
  std::map<Key, Kernel> kernels_;
  Key of_grid_{};
  std::unique_ptr<BlurGrid> grid_;  // for a tile, with the kernel of `of_grid_`
  ExpectedElectronImage tile_;
};

}  // namespace dmise
