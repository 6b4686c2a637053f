#pragma once
#include "core/pictures/picture_file.h"

namespace dmise {

/// Interface of the picture module: encodes and decodes picture files. The caller has checked the
/// pixels. Methods throw `Error` with the library's message.
class PictureCodec {
 public:
  virtual ~PictureCodec() = default;
  virtual std::string encode(const Picture& picture, const std::string& format) = 0;
  /// Writes the channels in the given order.
  virtual std::string encode_exr(const ExrImage& image) = 0;
  virtual LinearPicture decode(std::string_view bytes, const std::string& format,
                               PictureOf what) = 0;
};

}  // namespace dmise
