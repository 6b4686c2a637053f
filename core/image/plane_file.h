#pragma once
#include <span>
#include <string>

#include "core/products/frame_header.h"

namespace dmise {

/// A quantity per pixel, written beside a frame.
struct Plane {
  std::string name;               // EXTNAME: "SOURCES"
  std::string unit;               // BUNIT, as FITS spells it: "electron/s"
  std::string what;               // comment of EXTNAME
  std::span<const float> pixels;  // rows x columns
  int columns = 0;
};

/// Writes a FITS image of 32-bit floats with the frame's header and world coordinates, atomically.
/// Equal input gives equal bytes. Throws `Error` with the file's name, also for a value that is not
/// finite.
void write_plane(const std::string& path, const Plane& plane, const FrameHeader& header);

}  // namespace dmise
