#include "core/orbit/cone_kernel.h"

namespace dmise {
const ConeWords cone_words_sse2 = cone_words;
}  // namespace dmise
