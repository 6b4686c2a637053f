#include "core/products/frame_file.h"

#include "core/base/formatted.h"

namespace dmise {

std::string frame_file_name(std::uint32_t frame, const char* ending) {
  return formatted("frame-%06u%s", frame, ending);
}

}  // namespace dmise
