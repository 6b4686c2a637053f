#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "core/config/scenario.h"
#include "core/optics/blur/blur_grid.h"
#include "core/optics/blur/defocus_blur.h"
#include "core/optics/blur/deposit.h"
#include "core/optics/blur/direct_blur.h"
#include "core/optics/blur/extended_light.h"
#include "core/optics/psf_model.h"
#include "core/optics/range_defocus.h"
#include "sensors/scene/frame_times.h"
#include "sensors/scene/gl_evaluator.h"

namespace dmise {

/// Puts the light of sources on the focal plane of one sensor, blurred by its optics and the air by
/// the method that its plan chose. Keeps kernels and memory between frames.
///
/// With the transform, sources above `bright_ratio` times the frame's limit are summed directly:
/// they would drown the others in single precision.
class OpticsStage {
 public:
  static constexpr double bright_ratio = 1e4;

  OpticsStage(const SensorConfig& sensor, std::uint64_t seed, Threads& threads);

  /// Points are drawn by this from now on, where they are not summed directly; what moves is still
  /// deposited. It must outlive the stage.
  void draw_by(GlEvaluator& evaluator) { evaluator_ = &evaluator; }

  const PsfPlan& plan() const { return plan_; }
  /// Full width at half maximum before pixel integration, in the centre; of a drifting focus that
  /// of the frame, about.
  double fwhm_px() const;

  /// Starts a frame: the exposure's kernels, where they differ from the last. `limit_e`: electrons
  /// of the faintest source that matters.
  void begin(const FrameTimes& exposure, double limit_e);
  double limit_e() const { return limit_e_; }
  /// How far beside the frame light of extended sources still reaches into it, at most
  /// `disc_margin_px`.
  int reach_px() const;
  /// Adds the light of an extended source, blurred, to `light`: before the first arc of a frame.
  /// Where arcs are summed one by one the blur is a Gaussian of its width.
  void add_extended(const ExtendedLight& source, ExpectedElectronImage& light);
  /// Puts light on the plane; returns what of each arc fell inside the frame, where its pixels
  /// collect light.
  std::vector<Deposited> add(std::span<const Arc> arcs, ExpectedElectronImage& light,
                             DepositSums sums = DepositSums::all);
  /// Defocus in which what is at a range is drawn, at a level of `range_defocus`; that of stars
  /// where the level takes no notice of the difference.
  double defocus_at_m(double range_m, int level) const;
  /// Diameter of the disc of a defocus [px]; 0: of that of stars.
  double disc_px(double defocus_m) const;
  /// How far from its place light of such a defocus may be.
  double reach_px(double defocus_m);
  /// Puts light on the plane in such a defocus; returns what fell inside the frame.
  Deposited add(std::span<const Arc> arcs, double defocus_m, ExpectedElectronImage& light);
  /// Blurs and adds what is still on the grid; then the light is complete, nowhere negative.
  void finish(ExpectedElectronImage& light);

 private:
  void make_kernels();
  bool set_defocus(double time_s);
  std::vector<Deposited> put(std::span<const Arc> arcs, const DepositView& view, DepositSums sums);
  std::vector<Deposited> sum_directly(std::span<const Arc> arcs, ExpectedElectronImage& light);

  DefocusBlur& out_of_focus();

  Optics optics_;
  bool blurs_;              // the effect psf is on
  int border_px_;           // width of the reference pixels, which collect no light
  bool drifts_;             // its focus
  double defocus_m_ = 0.0;  // in this frame
  PsfPlan plan_;
  PsfTable table_;  // for deposits: the Gaussian's, or the grid's
  Threads& threads_;
  GlEvaluator* evaluator_ = nullptr;  // null: arcs are deposited
  std::unique_ptr<PsfModel> model_;
  std::unique_ptr<BlurGrid> grid_;
  std::unique_ptr<DirectBlur> direct_;
  std::optional<DefocusScale> scale_;          // none: nothing is blurred
  std::unique_ptr<DefocusBlur> out_of_focus_;  // null: nothing was yet
  PsfKernel central_;                          // at the boresight
  bool direct_ready_ = false;                  // `direct_` holds `central_`
  bool has_kernels_ = false;
  double limit_e_ = 0.0, bright_e_ = 0.0, exposure_start_s_ = 0.0, exposure_s_ = 0.0;
};

}  // namespace dmise
