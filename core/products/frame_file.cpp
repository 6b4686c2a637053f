#include "core/products/frame_file.h"

#include <cstdio>

namespace dmise {

std::string frame_file_name(std::uint32_t frame, const char* ending) {
  char number[16];
  std::snprintf(number, sizeof number, "%06u", frame);
  return std::string("frame-") + number + ending;
}

}  // namespace dmise
