#include "core/orbit/cones/cone_kernel.h"

namespace dmise::generic {
const ConeKernels cone_kernels = {present_words, cone_words};
}  // namespace dmise::generic
