#pragma once
#include "core/pictures/picture_file.h"

namespace dmise {

/// What the module does: bytes of picture files to and from pixels that were checked. Methods throw
/// `Error` with the library's words.
class PictureCodec {
 public:
  virtual ~PictureCodec() = default;
  virtual std::string encode(const Picture& picture, const std::string& format) = 0;
  /// `channels` in the order of the file.
  virtual std::string encode_exr(const ExrImage& image,
                                 const std::vector<ExrChannel>& channels) = 0;
  virtual LinearPicture decode(std::string_view bytes, const std::string& format,
                               PictureOf what) = 0;
};

}  // namespace dmise
