#pragma once
#include <vector>

namespace dmise {

struct ExportRequest;
struct ExportedFile;

/// SatNet's directories as SatSim writes them, one for each sensor: Annotations/NAME.0001.json and,
/// where the run kept frames, ImageFiles/NAME.0001.fits. Places are fractions of the image from its
/// edge: (pixel + 0.5) / size, rows as y. Boxes have SatSim's `box_pad` of `label_margin_fwhm`.
std::vector<ExportedFile> satnet_files(const ExportRequest& request);

}  // namespace dmise
