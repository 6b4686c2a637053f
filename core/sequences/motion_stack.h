#pragma once
#include <functional>
#include <vector>

#include "core/base/parallel.h"
#include "core/sequences/track_fit.h"

namespace dmise {

/// Called with the share of the work that is done.
using StackProgress = std::function<void(double)>;

/// Rates that are tried, so dense that a point moves by less than the PSF's width between the
/// nearest one and its own.
std::vector<PixelPosition> trial_rates(const FilteredSequence& sequence, const MotionRange& range);
/// Number of rates of `trial_rates`, about.
double count_of_trial_rates(const FilteredSequence& sequence, const MotionRange& range);

/// SNR that noise reaches along some motion of the range in one of 1000 sequences: the expected
/// number of maxima of a normal field over two dimensions of place and two of rate (Adler 1981, The
/// Geometry of Random Fields, theorem 6.3.1).
double stack_threshold(const FilteredSequence& sequence, const MotionRange& range);

/// Shifts and adds the frames along each rate, and returns motions whose sum has an SNR of
/// `min_snr`, by falling SNR. No frame counts for more than `max_snr_of_frame` at a place. The sums
/// are at whole pixels: what they find has to be fitted. Equal for any number of threads.
std::vector<SkyMotion> stack_motions(const TrackScene& scene, double min_snr, Threads& threads,
                                     const StackProgress& progress = {});

}  // namespace dmise
