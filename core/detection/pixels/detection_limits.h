#pragma once

// Limits of detection. SNRs are in units of the matched filter's noise.
namespace dmise::detection_limits {

inline constexpr int background_cell_px = 64;
inline constexpr double seed_snr = 5.0;       // minimum peak of a source in the filtered frame
inline constexpr double connect_snr = 3.0;    // threshold of its pixels
inline constexpr double min_snr = 6.0;        // minimum SNR of the fitted flux
inline constexpr double min_light_snr = 3.0;  // minimum SNR of the flux with errors of the ends
// A streak's minimum SNR with errors of its ends and of columns, and an SNR by the matched filter
// that no noise reaches.
inline constexpr double min_published_snr = 4.0, sure_snr = 15.0;
// The latter of a camera of which no noise of columns is known, and what the first must then be.
inline constexpr double sure_snr_of_pixels = 9.0, min_sure_snr = 2.0;
// Minimum difference between a source's trail and a star's.
inline constexpr double min_difference_px = 1.5;
// Minimum SNR of a streak against the scatter of stars beside it.
inline constexpr double min_snr_in_stars = 10.0;
// Minimum SNR at which a streak's evenness is measurable: in total, and per px.
inline constexpr double even_snr = 25.0, even_snr_per_px = 5.0;
// Deviance by which a short streak must beat two blended stars; a point that is no star; a row of
// two to four stars, corrected for chance; a star's trail beside another's.
inline constexpr double blend_margin = 16.0, line_margin = 8.0, chain_margin = 6.0,
                        trail_margin = 4.0;
// Length of stars' trails in sigmas of the PSF, from which two points are no blend of two stars.
inline constexpr double long_trail_sigmas = 4.0;
// SNR over the root of the length of a streak [px], below which its ends are lost in noise.
inline constexpr double faint_per_px = 4.0;
// Longest blend of stars, without their trails, that pixels above the threshold may be.
inline constexpr double chain_px = 30.0;
// Relative error of the PSF in comparisons of shape.
inline constexpr double model_error = 0.03;
// Relative error of the wings of a saturated source: per square of the sigma at which they begin,
// with minimum and maximum.
inline constexpr double wings_error = 0.02, min_wings_error = 0.1, max_wings_error = 0.5;
// Where the background's level is missed by more than this in units of a pixel's noise, streaks
// without a single bright pixel are not searched for.
inline constexpr double max_bend_in_noise = 0.15;

}  // namespace dmise::detection_limits
