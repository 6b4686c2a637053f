#pragma once
#include <string>
#include <string_view>

#include "core/base/image.h"
#include "core/detector/pixel_flags.h"
#include "core/products/frame_header.h"

namespace dmise {

struct Frame {
  CountImage counts;
  FrameHeader header;
};

/// How pixels are stored: as they are, or by Rice's code without loss.
enum class FitsCompression { none, rice };

/// A FITS file without compression in memory: 16-bit unsigned (BZERO 32768), row 0 first. `flags`
/// follow as an 8-bit image in an extension of the name FLAGS; a WCS with refraction has two lookup
/// tables at the end, WCSDVARR. Equal input gives equal bytes. Throws `Error`.
std::string encode_frame(const CountImage& counts, const FrameHeader& header,
                         const FlagImage* flags = nullptr);

/// Reads the counts that `write_frame` wrote, or any FITS file with the same keywords. `name`
/// stands in messages. Throws `ConfigError` "NAME: KEYWORD: reason" for anything else, hostile
/// input included.
Frame decode_frame(std::string_view bytes, const std::string& name);

/// The same as a file; with Rice compression the counts are a tiled image (RICE_1) in the first
/// extension, and the flags in the next. Whole or not at all; an `Error` names the file.
void write_frame(const std::string& path, const CountImage& counts, const FrameHeader& header,
                 FitsCompression compression = FitsCompression::none,
                 const FlagImage* flags = nullptr);
/// Also a gzipped file.
Frame read_frame(const std::string& path);

}  // namespace dmise
