#include "core/detector/detector_figures.h"

namespace dmise {
namespace {

using D = Detector;
constexpr double absolute_zero_c = -273.15, hottest_c = 100.0;

constexpr DetectorFigure table[] = {
    {"quantum_efficiency", "QUANTEFF", "photo-electrons a photon, mean over the band",
     &D::quantum_efficiency, 0.0, 1.0, true},
    {"dark_e_per_s", "", "", &D::dark_e_per_s, 0.0, 1e9},
    {"dark_reference_c", "DARKREFT", "[deg C] where dark currents are known", &D::dark_reference_c,
     absolute_zero_c, hottest_c},
    {"temperature_c", "DET-TEMP", "[deg C] of the detector", &D::temperature_c, absolute_zero_c,
     hottest_c},
    {"dark_doubling_k", "DARKDBL", "[K] warming that doubles dark current", &D::dark_doubling_k,
     0.0, 100.0},
    {"read_noise_e", "", "", &D::read_noise_e, 0.0, 1e6},
    {"full_well_e", "", "", &D::full_well_e, 0.0, 1e9, true, true},
    {"gain_e_per_dn", "", "", &D::gain_e_per_dn, 0.0, 1e6, true, true},
    {"bias_dn", "", "", &D::bias_dn, 0.0, 65535.0},
    {"prnu_rms", "PRNU", "rms of the pixels' responses, relative", &D::prnu_rms, 0.0, 0.2},
    {"hot_pixel_fraction", "HOTFRAC", "share of hot pixels", &D::hot_pixel_fraction, 0.0, 1.0},
    {"hot_pixel_e_per_s", "HOTRATE", "[e-/s] mean extra dark current of hot pixels",
     &D::hot_pixel_e_per_s, 0.0, 1e9},
    {"column_noise_e", "COLNOISE", "[e-] rms offset of a column", &D::column_noise_e, 0.0, 1e6},
    {"nonlinearity", "NONLIN", "relative loss of signal at full well", &D::nonlinearity, 0.0, 0.5},
    {"interpixel_coupling", "IPC", "share of signal seen by each neighbour",
     &D::interpixel_coupling, 0.0, 0.2},
    {"persistence_fraction", "PERSFRAC", "share of the charge that is trapped",
     &D::persistence_fraction, 0.0, 1.0},
    {"persistence_s", "PERSTAU", "[s] time constant of trapped charge", &D::persistence_s, 0.0,
     1e6},
    {"cosmic_rays_per_px_s", "CRRATE", "[1/s/px] hits by charged particles",
     &D::cosmic_rays_per_px_s, 0.0, 1e-3},
    {"cosmic_ray_e_per_px", "CRCHARGE", "[e-] left in a pixel pitch of track",
     &D::cosmic_ray_e_per_px, 0.0, 1e6},
    {"cosmic_ray_depth_px", "CRDEPTH", "[px] depth of the sensitive layer", &D::cosmic_ray_depth_px,
     0.0, 100.0, true},
};

}  // namespace

std::span<const DetectorFigure> detector_figures() { return table; }

}  // namespace dmise
