#include "core/orbit/cone_kernel.h"

namespace dmise {
const ConeWords cone_words_avx2 = cone_words;
}  // namespace dmise
