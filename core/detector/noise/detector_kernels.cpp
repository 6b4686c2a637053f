#include "core/detector/noise/detector_kernels.h"

#include "core/detector/noise/poisson_lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

constexpr std::size_t group = 4 * rng_group;  // pixels processed together

// One group of pixels; false, and nothing written, if one of the means is invalid.
DMISE_INLINE bool poisson_group(const RngKey& key, std::uint32_t first, const float* mean,
                                float* out) {
  I32 fine = I32{} - 1, large = fine;
  for (std::size_t i = 0; i < group; i += lanes) {
    const F32 m = load<F32>(mean + i);
    fine &= (m >= 0.0f) & (m <= 1e12f);
    large &= m >= 24.0f;
  }
  if (!all(fine)) return false;
  alignas(64) std::uint32_t high[group], low[group];
  words_of<group>(key, first, 0, high);
  if (all(large)) {
    for (std::size_t i = 0; i < group; i += lanes)
      store(out + i, poisson_large(load<F32>(mean + i), load<U32>(high + i)));
    return true;
  }
  bool have_low = false;
  for (std::size_t i = 0; i < group; i += lanes) {
    const F32 m = load<F32>(mean + i);
    const I32 small = m < 24.0f;
    F32 n{};
    if (!all(small)) n = poisson_large(max(m, splat(24.0f)), load<U32>(high + i));
    if (any(small)) {
      if (!have_low) words_of<group>(key, first, 1, low);
      have_low = true;
      alignas(64) float few[lanes];
      for (std::size_t h = 0; h < lanes; h += wide_lanes) {
        const F64 wide = __builtin_convertvector(load<F32Half>(mean + i + h), F64);
        const U64 a = __builtin_convertvector(load<U32Half>(high + i + h), U64);
        const U64 b = __builtin_convertvector(load<U32Half>(low + i + h), U64);
        // Lanes of the other branch must not prolong the search.
        const F64 u = wide < 24.0 ? uniform_of(a, b) : F64{};
        const F64 k = poisson_small(wide < 24.0 ? wide : F64{}, u);
        store(few + h, __builtin_convertvector(k, F32Half));
      }
      n = small ? load<F32>(few) : n;
    }
    store(out + i, n);
  }
  return true;
}

// Calls work(group from i on, number of valid pixels); an incomplete group is copied out of and
// back into `data`.
template <class T, class Work>
DMISE_INLINE void in_groups(T* data, std::size_t count, T fill, const Work& work) {
  std::size_t i = 0;
  for (; i + group <= count; i += group) work(i, data + i);
  if (i == count) return;
  T last[group];
  for (std::size_t j = 0; j < group; ++j) last[j] = i + j < count ? data[i + j] : fill;
  work(i, last);
  for (std::size_t j = i; j < count; ++j) data[j] = last[j - i];
}

}  // namespace

std::size_t poisson(const RngKey& key, std::uint32_t first, const float* mean, std::size_t count,
                    float* out) {
  std::size_t i = 0;
  for (; i + group <= count; i += group)
    if (!poisson_group(key, first + std::uint32_t(i), mean + i, out + i)) return i;
  if (i < count) {
    float m[group], n[group];
    for (std::size_t j = 0; j < group; ++j) m[j] = i + j < count ? mean[i + j] : 0.0f;
    if (!poisson_group(key, first + std::uint32_t(i), m, n)) return i;
    for (std::size_t j = i; j < count; ++j) out[j] = n[j - i];
  }
  return count;
}

int poisson_cumulative(float mean, double* cumulative) {
  double p = exp_of_lanes(splat(-double(mean)))[0], sum = p;
  int k = 0;
  for (; k < poisson_most_steps; ++k) {
    cumulative[k] = sum;
    if (sum >= 1.0 - 0x1p-53) return k + 1;
    p = p * (double(mean) * reciprocals.of[k + 1]);
    sum += p;
  }
  return k;
}

bool add_exceeded(const RngKey& key, std::uint32_t first, const std::uint32_t* thresholds,
                  int steps, float* sum, std::size_t count) {
  bool ties = false;
  in_groups(sum, count, 0.0f, [&](std::size_t i, float* e) {
    alignas(64) std::uint32_t words[group];
    words_of<group>(key, first + std::uint32_t(i), 0, words);
    for (std::size_t j = 0; j < group; j += lanes) {
      const U32 word = load<U32>(words + j);
      I32 exceeded{}, equal{};
      for (int k = 0; k < steps; ++k) {
        const U32 threshold = U32{} + thresholds[k];
        const I32 above = word > threshold;
        equal |= word == threshold;
        exceeded -= above;
        if (!any(above)) break;
      }
      ties = ties || any(equal);
      store(e + j, load<F32>(e + j) + to_f32(exceeded));
    }
  });
  return ties;
}

void add_normal(const RngKey& key, std::uint32_t first, float sigma, float* sum,
                std::size_t count) {
  in_groups(sum, count, 0.0f, [&](std::size_t i, float* e) {
    alignas(64) std::uint32_t words[group];
    words_of<group>(key, first + std::uint32_t(i), 0, words);
    for (std::size_t j = 0; j < group; j += 2 * lanes) {  // two, to hide latency
      const F32 a = normal_of_words(load<U32>(words + j));
      const F32 b = normal_of_words(load<U32>(words + j + lanes));
      store(e + j, load<F32>(e + j) + sigma * a);
      store(e + j + lanes, load<F32>(e + j + lanes) + sigma * b);
    }
  });
}

void add_normal_of_light(const RngKey& key, std::uint32_t first, float offset, float variance,
                         float* light, std::size_t count) {
  in_groups(light, count, 0.0f, [&](std::size_t i, float* e) {
    alignas(64) std::uint32_t words[group];
    words_of<group>(key, first + std::uint32_t(i), 0, words);
    for (std::size_t j = 0; j < group; j += lanes) {
      const F32 mean = max(load<F32>(e + j) + splat(offset), F32{});
      const F32 sigma = sqrt(mean + splat(variance));
      store(e + j, mean + sigma * normal_of_words(load<U32>(words + j)));
    }
  });
}

bool copy_light(const float* in, std::size_t count, float* out) {
  std::int32_t bad = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bad |= in[i] >= 0.0f && in[i] <= 3.4e38f ? 0 : 1;
    out[i] = in[i] < 4e11f ? in[i] : 4e11f;
  }
  return bad == 0;
}

std::size_t clip(float limit, float* values, std::size_t count) {
  std::size_t reached = 0;
  for (std::size_t i = 0; i < count; ++i) {
    reached += values[i] >= limit;
    values[i] = values[i] < limit ? values[i] : limit;
  }
  return reached;
}

std::size_t digitise(const float* e, std::size_t count, float dn_per_e, float bias_dn,
                     float highest_dn, std::uint16_t* counts) {
  std::size_t reached = 0;
  for (std::size_t i = 0; i < count; ++i) {
    float dn = e[i] * dn_per_e + bias_dn + 0.5f;
    dn = dn > 0.0f ? dn : 0.0f;
    dn = dn < highest_dn + 0.5f ? dn : highest_dn;
    const auto whole = std::int32_t(dn);
    reached += float(whole) >= highest_dn;
    counts[i] = std::uint16_t(whole);
  }
  return reached;
}

}  // namespace dmise::DMISE_SIMD
