#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/base/image.h"
#include "core/detector/noise/pixel_flags.h"
#include "core/products/frame_header.h"
#include "core/products/frame_notes.h"
#include "core/products/pixel_mask.h"

namespace dmise {

struct Frame {
  CountImage counts;
  FrameHeader header;
  PixelMask unusable{};                       // pixels without a value
  FrameNotes notes{};                         // on another camera's frame (core/ingest)
  double count_zero = 0.0, count_step = 1.0;  // a count is (value in the file - zero) / step
};

/// Storage of pixels: uncompressed, or losslessly Rice-compressed.
enum class FitsCompression { none, rice };

/// Encodes an uncompressed FITS file: 16-bit unsigned (BZERO 32768), row 0 first. `flags` follow as
/// an 8-bit image in the extension FLAGS; a WCS with refraction has two lookup tables at the end,
/// WCSDVARR. Equal input gives equal bytes. Throws `Error`.
std::string encode_frame(const CountImage& counts, const FrameHeader& header,
                         const FlagImage* flags = nullptr);

/// The cards of 80 characters with which `encode_frame` begins, without END.
std::vector<std::string> frame_file_cards(const CountImage& counts, const FrameHeader& header);

/// Decodes a file of `write_frame`, or any FITS file with the same keywords. `name` is used in
/// messages. Throws `ConfigError` "NAME: KEYWORD: reason" for any other input, malicious files
/// included.
Frame decode_frame(std::string_view bytes, const std::string& name);

/// Writes the same atomically to a file; with Rice compression the counts are a tiled image
/// (RICE_1) in the first extension, and the flags in the next. An `Error` names the file.
void write_frame(const std::string& path, const CountImage& counts, const FrameHeader& header,
                 FitsCompression compression = FitsCompression::none,
                 const FlagImage* flags = nullptr);
/// Reads a frame from a file, optionally gzipped.
Frame read_frame(const std::string& path);

}  // namespace dmise
