#include "core/detection/frame_scene.h"

#include "core/detection/make_report.h"
#include "core/detection/pixels/components.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/stars/psf_measure.h"

namespace dmise {

Scene frame_scene(const CountImage& counts, const Background& background, const StarMotion& stars,
                  const FrameHeader& header, const PixelMask* unusable) {
  return {counts,
          background,
          stars,
          header.gain_e_per_dn,
          lowest_clipped_dn(header),
          sigma_with_pixel(header.psf_fwhm_px),
          header.detector && header.detector->blooming,
          PsfField::gaussian(header.psf_fwhm_px),
          unusable};
}

void use_psf_of_stars(Scene& scene, Threads& threads) {
  scene.use(measure_psf(
      scene, find_components(scene.counts, scene.background, scene.sigma_px,
                             detection_limits::connect_snr, detection_limits::seed_snr, threads)));
}

}  // namespace dmise
