#include "launch/survey/coastlines.h"

namespace dmise {

const std::vector<std::vector<CoastPoint>>& coastlines() {
  static const std::vector<std::vector<CoastPoint>> lines{
#include "launch/survey/coastlines.inc"
  };
  return lines;
}

}  // namespace dmise
