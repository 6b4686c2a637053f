#pragma once
#include <string>
#include <variant>
#include <vector>

namespace dmise {

/// What an EXR file says beside its pixels; viewers show it.
struct ExrAttribute {
  std::string name;  // at most 31 characters
  std::variant<std::string, double> value;
};

struct ExrChannel {
  std::string name;               // at most 31 characters
  const float* pixels = nullptr;  // rows x columns, first row first
};

/// An image of channels of 32-bit floats, one as a rule.
struct ExrImage {
  std::string channel = "Y";      // at most 31 characters; Y is what viewers show as grey
  const float* pixels = nullptr;  // rows x columns, first row first
  int columns = 0, rows = 0;
  std::vector<ExrAttribute> attributes;
  std::vector<ExrChannel> more;  // beside `channel`, of other names
};

/// A single-part scan-line OpenEXR file with ZIP compression (blocks of 16 rows, without loss), as
/// the "OpenEXR File Layout" of the Academy Software Foundation describes it. Equal input gives
/// equal bytes. Throws `Error` for an image or a name that can't be.
std::string encode_exr(const ExrImage& image);

/// Whole or not at all; an `Error` names the file.
void write_exr(const std::string& path, const ExrImage& image);

}  // namespace dmise
