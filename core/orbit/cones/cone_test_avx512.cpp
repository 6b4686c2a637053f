#include "core/orbit/cones/cone_kernel.h"

namespace dmise::avx512 {
const ConeKernels cone_kernels = {present_words, cone_words};
}  // namespace dmise::avx512
