#pragma once
#include "core/ingest/standard_cards.h"
#include "core/products/frame_header.h"

namespace dmise {

/// Where a frame stands in its file.
struct PlanePlace {
  int plane = 0, planes = 1;  // from 0
};

/// Sets what `header` says of sensor, time, site, band, zero point and pointing from standard
/// keywords; `columns` and `rows` of the image. Facts that stay unknown are noted, added to
/// `header.unknown`, and have stand-ins: an exposure of 1 s, the direction (0, 0), and 1e4 px for
/// the focal length.
void set_facts(const StandardCards& cards, const PlanePlace& place, int columns, int rows,
               FrameHeader& header);

}  // namespace dmise
