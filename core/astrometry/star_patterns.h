#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/astrometry/plate_sky.h"

// Patterns of a star and two or three of its nearest brighter neighbours. They follow from the
// order of brightness alone: an image shows those of the catalogue whatever its scale, field and
// limiting magnitude, bright stars make large ones and faint stars small ones.
namespace dmise {

/// Place of `d` on the stereographic plane that touches the sphere at `centre` (unit vectors).
/// Stereographic, so that shapes are kept.
template <class F>
std::complex<double> plane_place(const Vec<F>& centre, const Vec<F>& d) {
  const Vec<F> pole = std::abs(centre.z) < 0.7 ? Vec<F>{0, 0, 1} : Vec<F>{1, 0, 0};
  const Vec<F> east = unit(cross(pole, centre)), north = cross(centre, east);
  const double scale = 2 / (1 + dot(centre, d));
  return {dot(d, east) * scale, dot(d, north) * scale};
}

/// A pattern of a star and others by falling distance from it. The code is where the second and the
/// third lie if the star is at 0 and the first at 1, so that it does not depend on rotation and
/// scale.
struct StarPattern {
  using Code = std::array<std::int16_t, 4>;         // second and third, real and imaginary
  static constexpr double code_unit = 1.0 / 16384;  // their places are within the unit circle

  std::array<std::uint8_t, 3> others{};  // places among the neighbours; a triangle has two
  Code code{};
};

/// Calls `visit(pattern)` for each choice of `others` (2 or 3) of a star's neighbours, which are at
/// `places` on its plane.
template <class Visit>
void visit_patterns(std::span<const std::complex<double>> places, int others, Visit&& visit) {
  const auto n = std::uint8_t(places.size());
  std::array<std::uint8_t, 3> pick{};
  const auto one = [&] {
    StarPattern p{.others = pick};
    const auto sort_two = [&](std::size_t a, std::size_t b) {
      if (std::norm(places[p.others[a]]) < std::norm(places[p.others[b]]))
        std::swap(p.others[a], p.others[b]);
    };
    sort_two(0, 1);
    if (others == 3) {
      sort_two(1, 2);
      sort_two(0, 1);
    }
    // z / first written out: the library's division also handles infinities.
    const std::complex<double> first = places[p.others[0]];
    const double unit = 1 / (StarPattern::code_unit * std::norm(first));
    if (!std::isfinite(unit)) return;
    for (std::size_t i = 1; i < std::size_t(others); ++i) {
      const std::complex<double> z = places[p.others[i]];
      const double along = z.real() * first.real() + z.imag() * first.imag();
      const double across = z.imag() * first.real() - z.real() * first.imag();
      p.code[2 * i - 2] = std::int16_t(std::lrint(along * unit));
      p.code[2 * i - 1] = std::int16_t(std::lrint(across * unit));
    }
    visit(p);
  };
  for (pick[0] = 0; pick[0] < n; ++pick[0])
    for (pick[1] = std::uint8_t(pick[0] + 1); pick[1] < n; ++pick[1]) {
      if (others == 2)
        one();
      else
        for (pick[2] = std::uint8_t(pick[1] + 1); pick[2] < n; ++pick[2]) one();
    }
}

/// Patterns of the catalogue, found by their codes.
class PatternIndex {
 public:
  /// Takes `stars` of the catalogue and `neighbours` of each, 2 or 3 `others` at a time.
  PatternIndex(const PlateSky& sky, std::vector<std::uint32_t> stars, std::size_t neighbours,
               int others);

  std::size_t size() const { return entries_.size(); }
  int others() const { return others_; }
  /// Calls `visit(stars)` for each pattern whose code differs by at most `tolerance` in each part:
  /// the star and its others, by number in the catalogue; a triangle repeats the star.
  template <class Visit>
  void find(const StarPattern::Code& code, double tolerance, Visit&& visit) const {
    const int within = int(tolerance / StarPattern::code_unit);
    for (int i = bin(code[0] - within); i <= bin(code[0] + within); ++i)
      for (int j = bin(code[1] - within); j <= bin(code[1] + within); ++j) {
        const std::size_t from = cell(i, j, bin(code[2] - within));
        const std::size_t to = cell(i, j, bin(code[2] + within));
        for (std::uint32_t k = first_[from]; k < first_[to + 1]; ++k) {
          const Entry& e = entries_[k];
          bool near = true;
          for (std::size_t c = 0; c < 4; ++c)
            near = near && std::abs(e.pattern.code[c] - code[c]) <= within;
          if (near) visit(stars_of(e));
        }
      }
  }

 private:
  struct Entry {
    std::uint32_t star = 0;  // place in `stars_`
    StarPattern pattern;
  };
  static constexpr int bins = 50;
  static int bin(int code) {
    const double place = (code * StarPattern::code_unit + 1.0) * (0.5 * bins);
    return std::clamp(int(place), 0, bins - 1);
  }
  static std::size_t cell(int i, int j, int k) { return std::size_t((i * bins + j) * bins + k); }
  static std::size_t cell_of(const StarPattern& p) {
    return cell(bin(p.code[0]), bin(p.code[1]), bin(p.code[2]));
  }
  std::array<std::uint32_t, 4> stars_of(const Entry& e) const;

  int others_;
  std::size_t neighbours_;
  std::vector<std::uint32_t> stars_, near_;  // `neighbours_` of each star
  std::vector<Entry> entries_;               // by cell
  std::vector<std::uint32_t> first_;         // first entry of each cell
};

/// Quads of a catalogue's whole sky, kept for further frames.
class PatternCache {
 public:
  /// Uses at least the stars up to a rank in brightness, and at most 400,000. `sky` must be of the
  /// same catalogue each time.
  const PatternIndex& whole_sky(const PlateSky& sky, double rank);
  /// Patterns of the stars beyond the 400,000 brightest, at most to the 3 millionth: frames
  /// narrower than a degree show whole patterns of these alone. Null if the rank or the catalogue
  /// ends before.
  const PatternIndex* fainter(const PlateSky& sky, double rank);

 private:
  std::optional<PatternIndex> fainter_;
  std::map<double, PatternIndex> by_rank_;
};

}  // namespace dmise
