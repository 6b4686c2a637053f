#include "core/orbit/cones/cone_kernel.h"

namespace dmise::sse2 {
const ConeKernels cone_kernels = {present_words, cone_words};
}  // namespace dmise::sse2
