#pragma once

namespace dmise {

/// Rendering and light sums of objects with a shape, on one core: see docs/models/rendering.md.
int bench_render(bool json);

}  // namespace dmise
