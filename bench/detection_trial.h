#pragma once
#include <memory>

#include "core/detection/known/catalogue_sky.h"
#include "core/products/detection.h"
#include "tests/support/simulated_frame.h"

namespace dmise {

/// A source in a simulated frame; length 0 is a point.
struct PlacedSource {
  double x = 0.0, y = 0.0, length = 0.0, angle = 0.0, flux_e = 0.0;
};

/// A field of the real sky; without a catalogue a field without stars.
struct StarField {
  const CatalogueSky* sky = nullptr;
  double ra_rad = 0.0, dec_rad = 0.0;
};

/// What became of sources of one length and SNR.
struct DetectionOutcome {
  int placed = 0, found = 0;
  double in_theory = 0.0;                     // that an ideal template finds, summed
  double squares_px2 = 0.0, bound_px2 = 0.0;  // errors, and the Cramer-Rao bound
  double nees = 0.0, bias_sigma = 0.0;        // sums over those found

  void add(const DetectionOutcome& other);
  double probability() const { return placed ? found / double(placed) : 0.0; }
  double probability_in_theory() const { return placed ? in_theory / placed : 0.0; }
};

/// Header of the trials' camera: 90 deg of sky on 3326 px, stars trail by 2 px if `exposure_s`
/// is 20. Its zero point makes what is just found as bright as the faintest star of a complete
/// `sky`, or fainter by `deeper_mag`.
FrameHeader trial_header(int columns, int rows, double exposure_s, const StarField& field,
                         double deeper_mag = 0.0);

/// A frame of that header with the sky's light and the field's stars, each of them 0.1 px beside
/// where the catalogue has it and 10 % brighter or fainter (standard deviations).
simulated::SimulatedFrame trial_frame(const FrameHeader& header, int columns, int rows,
                                      const StarField& field, unsigned seed);

/// Detects sources of one length [px] and matched-filter SNR at random places and angles in frames
/// of 1500 x 1500 px. In theory one is found with probability Q(threshold - SNR), where the SNR is
/// that of the part beside stars.
DetectionOutcome detection_trial(double length, double snr, double threshold, int frames,
                                 const StarField& field, unsigned seed);

/// SNR by which half are found later than in theory, at most 8.
double late_by_snr(double length, double threshold, int frames, const StarField& field,
                   unsigned seed);

}  // namespace dmise
