#pragma once

namespace dmise {

/// Relative standard deviation of a point source's light through one aperture: sigma^2 = 10e-6
/// D^(-4/3) / t X^3 exp(-2 h / 8000 m), D in metres, t in seconds. Exposures shorter than the
/// shadow pattern takes to cross the aperture (D / 20 m/s) average nothing: they count as that
/// long. Typical nights scatter by a factor 1.5 around it. Throws `Error` for an aperture <= 0 or
/// an exposure < 0. Source: Young 1967, AJ 72, 747; Osborn et al. 2015, MNRAS 452, 1707,
/// equation 7.
double scintillation_sigma(double aperture_m, double exposure_s, double airmass,
                           double site_height_m);

}  // namespace dmise
