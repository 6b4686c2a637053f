#pragma once
#include <cstddef>
#include <string>

#include "core/base/image.h"

namespace dmise {

/// A frame as a page carries it: means over `bin` x `bin` pixels, in steps of a third of their
/// noise. The value of pixel i is min_dn + step_dn * number i.
struct EmbeddedImage {
  int bin = 1;
  int columns = 0, rows = 0;  // counted in means; the last ones hold what is left
  double min_dn = 0.0, step_dn = 1.0;
  // Row-major uint16, each as its difference (modulo 2^16) from the left one, in the first column
  // from the one above; low bytes then high bytes: `compact`.
  std::string pixels;
};

/// The means of as few pixels as give at most `max_pixels`.
EmbeddedImage embed(const CountImage& counts, std::size_t max_pixels);

}  // namespace dmise
