#include "launch/coastlines.h"

namespace dmise {

const std::vector<std::vector<CoastPoint>>& coastlines() {
  static const std::vector<std::vector<CoastPoint>> lines{
#include "launch/coastlines.inc"
  };
  return lines;
}

}  // namespace dmise
