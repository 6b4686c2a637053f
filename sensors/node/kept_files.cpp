#include "sensors/node/kept_files.h"

#include <memory>

#include "core/base/mapped_file.h"
#include "core/image/fits_file.h"
#include "core/products/frame_file.h"

namespace dmise {
namespace {

/// The file is whole from when it has its name on.
FrameBytes mapped(const std::string& path) {
  const auto file = std::make_shared<const MappedFile>(path);
  const auto bytes = file->bytes();
  return {file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
}

}  // namespace

void keep_frame(const FrameProducts& frame, const OutputConfig& output,
                const std::string& directory, KeptFrames& kept) {
  if (output.fits) {
    kept.add(frame.report, [path = directory + "/" + frame_file_name(frame.report.frame)] {
      return mapped(path);
    });
  } else if (kept.wanted()) {
    const auto bytes = std::make_shared<const std::string>(
        encode_frame(frame.counts, frame.header, output.saturation ? &frame.flags : nullptr));
    kept.add(
        frame.report,
        [bytes] {
          return FrameBytes{bytes, *bytes};
        },
        bytes->size());
  } else {
    kept.add(frame.report, {});
  }
}

}  // namespace dmise
