#include "core/orbit/cone_kernel.h"

namespace dmise {
const ConeWords cone_words_avx512 = cone_words;
}  // namespace dmise
