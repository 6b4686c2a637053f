#pragma once
#include <cstdint>
#include <string>

namespace dmise {

/// Name of a file of a frame in the directory of its sensor: "frame-000007" + `ending`.
std::string frame_file_name(std::uint32_t frame, const char* ending = ".fits");

}  // namespace dmise
