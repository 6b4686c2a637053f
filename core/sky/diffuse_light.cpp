#include "core/sky/diffuse_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"
#include "core/sky/air/haze.h"

namespace dmise {
namespace {

constexpr int streams = 8;  // in each hemisphere: upwards first, then downwards

/// Nodes and weights of Gauss on [0, 1].
struct StreamAngles {
  std::array<double, 2 * streams> cosine, weight;

  StreamAngles() {
    for (int i = 0; i < streams; ++i) {
      double x = std::cos(pi * (i + 0.75) / (streams + 0.5)), slope = 1.0;
      for (int step = 0; step < 50; ++step) {
        double before = 1.0, p = x;
        for (int l = 2; l <= streams; ++l) {
          const double next = ((2 * l - 1) * x * p - (l - 1) * before) / l;
          before = p;
          p = next;
        }
        slope = streams * (x * p - before) / (x * x - 1.0);
        x -= p / slope;
      }
      const auto up = std::size_t(i), down = std::size_t(streams + i);
      cosine[up] = 0.5 * (1.0 + x);
      cosine[down] = -cosine[up];
      weight[up] = weight[down] = 1.0 / ((1.0 - x * x) * slope * slope);
    }
  }
};

const StreamAngles& stream_angles() {
  static const StreamAngles angles;
  return angles;
}

using Streams = std::array<double, 2 * streams>;
using Moments = std::array<double, DiffuseLight::modes>;  // l = m, m + 1, ..

/// How a layer passes light along a stream, and takes that of its two levels.
struct Passage {
  double through, from_start, from_end;

  explicit Passage(double depth) : through(std::exp(-depth)) {
    if (depth < 1e-3) {
      from_start = depth * (0.5 - depth / 3.0);
      from_end = depth * (0.5 - depth / 6.0);
    } else {
      const double mean = (1.0 - through) / depth;
      from_start = mean - through;
      from_end = 1.0 - mean;
    }
  }
};

/// One Fourier mode: orders of scattering are added until they are faint.
class ModeOfLight {
 public:
  ModeOfLight(const LayeredAir& air, const std::vector<Passage>& passages, int mode)
      : air_(air), passages_(passages), mode_(mode), count_(DiffuseLight::modes - mode) {
    const StreamAngles& angles = stream_angles();
    for (std::size_t j = 0; j < functions_.size(); ++j)
      legendre_functions(mode, angles.cosine[j],
                         std::span(functions_[j]).first(std::size_t(count_)));
    for (int k = 0; k < count_; ++k) {
      const int l = mode + k;
      haze_[std::size_t(k)] = (2 * l + 1) * haze_moment(l);
      molecules_[std::size_t(k)] = l == 0 ? 1.0 : l == 2 ? 0.5 : 0.0;
    }
  }

  /// Sources of second and higher orders, as moments: levels x moments.
  std::vector<double> sum_orders() {
    const std::size_t levels = air_.molecules.size();
    std::vector<Streams> source = of_sunlight(), light(levels);
    double ground = mode_ == 0 ? air_.ground_albedo / pi * std::max(0.0, air_.sun_cosine) *
                                     air_.sunlight.front()
                               : 0.0;  // radiance
    std::vector<double> sum(levels * std::size_t(count_), 0.0);
    constexpr int max_orders = 300;
    constexpr double faint = 1e-5;
    for (int order = 1; order <= max_orders; ++order) {
      pass(source, ground, light);
      const double down = flux_down(light.front());
      if (mode_ == 0) downward_ += down;
      ground = mode_ == 0 ? air_.ground_albedo / pi * down : 0.0;
      double largest = 0.0, largest_sum = 0.0;
      for (std::size_t i = 0; i < levels; ++i) {
        const Moments scattered = scatter(i, light[i]);
        source[i] = in_streams(scattered);
        for (int k = 0; k < count_; ++k) {
          double& total = sum[i * std::size_t(count_) + std::size_t(k)];
          total += scattered[std::size_t(k)];
          largest = std::max(largest, std::abs(scattered[std::size_t(k)]));
          largest_sum = std::max(largest_sum, std::abs(total));
        }
      }
      if (!(largest > faint * largest_sum)) break;
    }
    return sum;
  }
  double downward() const { return downward_; }

 private:
  Moments weighted(std::size_t level) const {
    Moments moments{};
    for (int k = 0; k < count_; ++k)
      moments[std::size_t(k)] = air_.molecules[level] * molecules_[std::size_t(k)] +
                                air_.haze[level] * haze_[std::size_t(k)];
    return moments;
  }
  Streams in_streams(const Moments& moments) const {
    Streams s{};
    for (std::size_t j = 0; j < s.size(); ++j)
      for (int k = 0; k < count_; ++k)
        s[j] += functions_[j][std::size_t(k)] * moments[std::size_t(k)];
    return s;
  }
  std::vector<Streams> of_sunlight() const {
    Moments sun{};
    legendre_functions(mode_, -air_.sun_cosine, std::span(sun).first(std::size_t(count_)));
    std::vector<Streams> source;
    for (std::size_t i = 0; i < air_.molecules.size(); ++i) {
      Moments moments = weighted(i);
      for (std::size_t k = 0; k < moments.size(); ++k)
        moments[k] *= (mode_ == 0 ? 1.0 : 2.0) / (4.0 * pi) * air_.sunlight[i] * sun[k];
      source.push_back(in_streams(moments));
    }
    return source;
  }
  Moments scatter(std::size_t level, const Streams& light) const {
    const StreamAngles& angles = stream_angles();
    Moments moments{};
    for (std::size_t j = 0; j < light.size(); ++j) {
      const double lit = 0.5 * angles.weight[j] * light[j];
      for (int k = 0; k < count_; ++k)
        moments[std::size_t(k)] += lit * functions_[j][std::size_t(k)];
    }
    const Moments phase = weighted(level);
    for (std::size_t k = 0; k < moments.size(); ++k) moments[k] *= phase[k];
    return moments;
  }
  /// Light of sources, and of the ground, at every level.
  void pass(const std::vector<Streams>& source, double ground, std::vector<Streams>& light) const {
    const std::size_t levels = light.size();
    for (std::size_t j = 0; j < std::size_t(streams); ++j) {
      light[0][j] = ground;
      for (std::size_t i = 0; i + 1 < levels; ++i) {
        const Passage& p = passages_[i * streams + j];
        light[i + 1][j] =
            light[i][j] * p.through + source[i][j] * p.from_start + source[i + 1][j] * p.from_end;
      }
      const std::size_t down = streams + j;
      light[levels - 1][down] = 0.0;
      for (std::size_t i = levels - 1; i-- > 0;) {
        const Passage& p = passages_[i * streams + j];
        light[i][down] = light[i + 1][down] * p.through + source[i + 1][down] * p.from_start +
                         source[i][down] * p.from_end;
      }
    }
  }
  double flux_down(const Streams& light) const {
    const StreamAngles& angles = stream_angles();
    double sum = 0.0;
    for (std::size_t j = 0; j < std::size_t(streams); ++j)
      sum += 2.0 * pi * angles.weight[j] * angles.cosine[j] * light[streams + j];
    return sum;
  }

  const LayeredAir& air_;
  const std::vector<Passage>& passages_;
  int mode_, count_;
  std::array<Moments, 2 * streams> functions_{};
  Moments haze_{}, molecules_{};
  double downward_ = 0.0;
};

}  // namespace

void legendre_functions(int m, double cosine, std::span<double> out) {
  const double sine2 = std::max(0.0, 1.0 - cosine * cosine);
  double first = 1.0;
  for (int k = 1; k <= m; ++k) first *= std::sqrt((2.0 * k - 1.0) / (2.0 * k) * sine2);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double l = double(m) + double(k), mm = double(m) * m;
    if (k == 0) {
      out[k] = first;
      continue;
    }
    const double two_before = k > 1 ? std::sqrt((l - 1.0) * (l - 1.0) - mm) * out[k - 2] : 0.0;
    out[k] = ((2.0 * l - 1.0) * cosine * out[k - 1] - two_before) / std::sqrt(l * l - mm);
  }
}

DiffuseLight::DiffuseLight(const LayeredAir& air) {
  std::vector<Passage> passages;
  for (const double depth : air.layer_depth)
    for (int j = 0; j < streams; ++j)
      passages.emplace_back(depth / stream_angles().cosine[std::size_t(j)]);
  const bool hazy = std::ranges::any_of(air.haze, [](double share) { return share > 0.0; });
  for (int mode = 0; mode < (hazy ? modes : 3); ++mode) {
    ModeOfLight one(air, passages, mode);
    moments_.push_back(one.sum_orders());
    if (mode == 0) downward_ = one.downward();
  }
}

double DiffuseLight::source(int mode, std::size_t level, std::span<const double> functions) const {
  const auto count = std::size_t(modes - mode);
  const double* moments = moments_[std::size_t(mode)].data() + level * count;
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += moments[k] * functions[k];
  return sum;
}

}  // namespace dmise
