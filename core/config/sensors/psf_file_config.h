#pragma once
#include "core/optics/camera.h"

namespace dmise {

class YamlValue;
struct Section;

const Section& psf_file_section();

/// Reads images of a point source from a FITS file, gzipped or not: a text is its path, a map has
/// more. Its cards are those of STPSF, POPPY and PSFEx. Throws `ConfigError` with the place of the
/// key, for malicious files too.
MeasuredPsfPointer read_psf_file(const YamlValue& value, const Optics& optics);

}  // namespace dmise
