#pragma once
#include <utility>

#include "core/base/parallel.h"
#include "core/detection/background.h"
#include "core/detection/detection_limits.h"
#include "core/detection/make_report.h"
#include "core/detection/psf.h"
#include "core/detection/scene.h"
#include "core/detection/star_motion.h"
#include "core/products/frame_header.h"

namespace dmise::simulated {

/// Counts prepared for fits, with the PSF of their header.
struct SimulatedScene {
  FrameHeader header;
  CountImage counts;
  Threads one;
  Background background{counts, detection_limits::background_cell_px, one};
  StarMotion stars{header, counts.columns, counts.rows};
  Scene scene{counts,
              background,
              stars,
              header.gain_e_per_dn,
              lowest_clipped_dn(header),
              sigma_with_pixel(header.psf_fwhm_px),
              false,
              PsfField::gaussian(header.psf_fwhm_px)};

  SimulatedScene(FrameHeader header_, CountImage counts_)
      : header(std::move(header_)), counts(std::move(counts_)) {}
  SimulatedScene(const SimulatedScene&) = delete;  // parts refer to each other
  SimulatedScene& operator=(const SimulatedScene&) = delete;
};

}  // namespace dmise::simulated
