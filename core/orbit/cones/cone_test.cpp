#include "core/orbit/cones/cone_test.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/orbit/cones/cone_kernels.h"

namespace dmise {
namespace {

constexpr std::size_t chunk_words = 8;  // 512 objects: 12 KB, in cache for every cone

PreparedCone prepare(const Cone& cone) {
  double cosine = std::cos(cone.half_angle_rad);
  PreparedCone p;
  p.wide = cosine < 0.0;
  const double sign = p.wide ? -1.0 : 1.0;
  const double scale = sign / std::max(std::fabs(cosine), 1e-100);
  p.apex[0] = cone.apex_m.x, p.apex[1] = cone.apex_m.y, p.apex[2] = cone.apex_m.z;
  p.axis[0] = cone.axis.x * scale, p.axis[1] = cone.axis.y * scale, p.axis[2] = cone.axis.z * scale;
  return p;
}

}  // namespace

void cone_test(std::span<const double> position_m, std::span<const Cone> cones,
               std::span<std::uint64_t> inside, Threads* threads, SimdLevel simd) {
  const std::size_t n = position_m.size() / 3;
  const std::size_t words = cone_words(n);
  if (position_m.size() != 3 * n || inside.size() != words * cones.size())
    throw Error("cone test of " + std::to_string(n) + " objects and " +
                std::to_string(cones.size()) + " cones: output has space for " +
                std::to_string(inside.size()) + " words");
  std::vector<PreparedCone> prepared(cones.size());
  std::transform(cones.begin(), cones.end(), prepared.begin(), prepare);
  const ConeKernels& kernels =
      *kernel_of(simd, &sse2::cone_kernels, &avx2::cone_kernels, &avx512::cone_kernels);

  const auto work = [&](std::size_t begin, std::size_t end) {
    alignas(64) double chunk[3][64 * chunk_words];
    std::uint64_t present[chunk_words];
    for (std::size_t w = begin; w < end; w += chunk_words) {
      const std::size_t count = std::min(chunk_words, end - w);
      const std::size_t objects = std::min(64 * count, n - 64 * w);
      for (std::size_t a = 0; a < 3; ++a) {
        const double* from = position_m.data() + a * n + 64 * w;
        std::copy(from, from + objects, chunk[a]);
        std::fill(chunk[a] + objects, chunk[a] + 64 * count, 0.0);
      }
      kernels.present(chunk[0], chunk[1], chunk[2], count, present);
      for (std::size_t s = 0; s < prepared.size(); ++s) {
        kernels.inside(chunk[0], chunk[1], chunk[2], count, prepared[s], present,
                       &inside[s * words + w]);
      }
    }
  };
  if (threads)
    threads->for_ranges(words, chunk_words * 8, work);
  else
    work(0, words);
}

}  // namespace dmise
