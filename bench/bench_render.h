#pragma once

namespace dmise {

/// Pictures and sums of light of objects with a shape, on one core: see docs/models/rendering.md.
int bench_render(bool json);

}  // namespace dmise
