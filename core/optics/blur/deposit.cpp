#include "core/optics/blur/deposit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/optics/blur/deposit_kernels.h"
#include "core/optics/blur/short_arcs.h"

namespace dmise {
namespace {

constexpr int band_rows = 128;
constexpr double panel_sigmas = 2.0, widest_panel_sigmas = 4.0;
// Gauss-Legendre on [-1, 1], five nodes.
constexpr double nodes[panel_nodes] = {-0.9061798459386640, -0.5384693101056831, 0.0,
                                       0.5384693101056831, 0.9061798459386640};
constexpr double node_weights[panel_nodes] = {0.2369268850561891, 0.4786286704993665,
                                              0.5688888888888889, 0.4786286704993665,
                                              0.2369268850561891};

// The arc as a polynomial of time: position = start + tau (slope + tau curve).
struct Motion {
  PixelPosition start, slope, curve;

  explicit Motion(const Arc& a)
      : start(a.start),
        slope(a.middle * 4.0 - a.start * 3.0 - a.end),
        curve((a.start + a.end) * 2.0 - a.middle * 4.0) {}
  PixelPosition at(double tau) const { return start + (slope + curve * tau) * tau; }
  double greatest_speed() const {
    const PixelPosition end = slope + curve * 2.0;
    return std::max(std::hypot(slope.x_px, slope.y_px), std::hypot(end.x_px, end.y_px));
  }
};

// Bounding box of the parabola between two times: the hull of its Bezier points.
ArcExtent bounds(const Motion& m, double tau0, double tau1) {
  const PixelPosition a = m.at(tau0), c = m.at(tau1);
  const PixelPosition b = a + (m.slope + m.curve * (2.0 * tau0)) * (0.5 * (tau1 - tau0));
  return {std::min({a.x_px, b.x_px, c.x_px}), std::min({a.y_px, b.y_px, c.y_px}),
          std::max({a.x_px, b.x_px, c.x_px}), std::max({a.y_px, b.y_px, c.y_px})};
}

// The part of the image plane whose light reaches rows [begin, end).
ArcExtent reach(const PsfTable& psf, const DepositView& view, int begin, int end) {
  const double r = psf.size;
  return {-r, begin - r, view.columns + r, end + r};
}

/// Whether the light that five nodes miss of an arc of `length` pixels may be missed: the tenth
/// derivative of a Gaussian as wide as one with a pixel, 945, in the remainder of the quadrature,
/// 3.94e-13 widths^10.
bool is_one_panel(const Arc& arc, const PsfTable& psf, double length) {
  if (!(arc.may_miss_e > 0.0) || length > widest_panel_sigmas * psf.sigma_px) return false;
  constexpr double missed = 945 * 3.94e-13, two_pi = 6.283185307179586;
  const double width2 = psf.sigma_px * psf.sigma_px + 1.0 / 12.0;
  const double square = length * length / width2, fourth = square * square;
  return arc.signal_e / (two_pi * width2) * missed * fourth * fourth * square <= arc.may_miss_e;
}

// Calls `use(panel)` for the panels of an arc that meet `box`, in the order of time.
template <class Use>
void for_panels(const Arc& arc, const PsfTable& psf, const ArcExtent& box, const Use& use) {
  const Motion motion(arc);
  const double length = motion.greatest_speed();
  PanelView panel;
  const auto put = [&](int k, PixelPosition at, double signal_e) {
    const double x = std::floor(at.x_px), y = std::floor(at.y_px);
    panel.column[k] = int(std::clamp(x, -1e9, 1e9));
    panel.row[k] = int(std::clamp(y, -1e9, 1e9));
    panel.phase_x[k] = float(at.x_px - x);
    panel.phase_y[k] = float(at.y_px - y);
    panel.weight[k] = float(signal_e);
  };
  if (length < 1e-4 * psf.sigma_px) {
    panel.nodes = 1;
    put(0, motion.at(0.5), arc.signal_e);
    if (bounds(motion, 0.0, 1.0).meets(box)) use(panel);
    return;
  }
  panel.nodes = panel_nodes;
  const double count =
      is_one_panel(arc, psf, length) ? 1.0 : std::ceil(length / (panel_sigmas * psf.sigma_px));
  const double step = 1.0 / count;
  const auto visit = [&](const auto& self, double begin, double end) -> void {
    if (!bounds(motion, begin * step, end * step).meets(box)) return;
    if (end - begin > 1.0) {
      const double half = std::floor(0.5 * (begin + end));
      self(self, begin, half);
      self(self, half, end);
      return;
    }
    for (int k = 0; k < panel_nodes; ++k) {
      const double tau = (begin + 0.5 + 0.5 * nodes[k]) * step;
      const double brightness = 1.0 + arc.tilt * (2.0 * tau - 1.0);
      put(k, motion.at(tau), arc.signal_e * brightness * 0.5 * node_weights[k] * step);
    }
    use(panel);
  };
  visit(visit, 0.0, count);
}

// Sum and first moment of a node's weights on one axis over `pixels` pixels from `from` on.
std::array<double, 2> shares_inside(const PsfTable& psf, int at, float phase, int from,
                                    int pixels) {
  const float position = phase * float(psf.phases);
  const int p = std::min(int(position), psf.phases - 1);
  const double f = position - float(p);
  const int first = at + psf.first;
  if (first >= from && first + psf.size <= from + pixels) {
    const auto &a = psf.whole[std::size_t(p)], &b = psf.whole[std::size_t(p) + 1];
    const double sum = a[0] + f * (b[0] - a[0]);
    return {sum, a[1] + f * (b[1] - a[1]) + sum * first};
  }
  const float* a = psf.weights.data() + std::size_t(p) * std::size_t(psf.stride);
  const float* b = a + psf.stride;
  double sum = 0.0, moment = 0.0;
  const int begin = std::max(0, from - first), end = std::min(psf.size, from + pixels - first);
  for (int i = begin; i < end; ++i) {
    const double share = a[i] + f * (double(b[i]) - double(a[i]));
    sum += share;
    moment += share * i;
  }
  return {sum, moment + sum * first};
}

/// Adds up what of an arc's panels is inside the frame.
struct Inside {
  const PsfTable& psf;
  const DepositView& view;
  double signal = 0.0, x = 0.0, y = 0.0;

  void add(const PanelView& panel) {
    for (int k = 0; k < panel.nodes; ++k) {
      const double w = panel.weight[k];
      const auto [sx, mx] =
          shares_inside(psf, panel.column[k], panel.phase_x[k], view.left, view.frame_columns);
      const auto [sy, my] =
          shares_inside(psf, panel.row[k], panel.phase_y[k], view.top, view.frame_rows);
      signal += w * sx * sy;
      x += w * mx * sy;
      y += w * sx * my;
    }
  }
  Deposited sum() const {
    return signal > 0.0 ? Deposited{signal, x / signal, y / signal} : Deposited{};
  }
};

Deposited inside(const Arc& arc, const PsfTable& psf, const DepositView& view) {
  Inside inside{psf, view};
  for_panels(arc, psf, reach(psf, view, 0, view.rows),
             [&](const PanelView& panel) { inside.add(panel); });
  return inside.sum();
}

/// The short arc of one that may miss some light, where a kernel takes it; else without nodes.
ShortArc short_arc(const Arc& arc, const Motion& m, const ArcExtent& box, const ShortArcRule& rule,
                   const PsfTable& psf, const DepositView& view) {
  ShortArc a{m.start.x_px, m.start.y_px, m.slope.x_px,       m.slope.y_px,
             m.curve.x_px, m.curve.y_px, float(arc.signal_e)};
  constexpr int window = 16;
  if (!(arc.may_miss_e > 0.0) || arc.tilt != 0.0 || psf.stride != window / 2 ||
      box.left < double(-psf.first) || box.left > double(view.columns - window - psf.first) ||
      box.right - box.left > longest_short_px || box.bottom - box.top > longest_short_px)
    return a;
  const PixelPosition end = m.slope + m.curve * 2.0;
  const auto square = [](PixelPosition p) { return p.x_px * p.x_px + p.y_px * p.y_px; };
  a.nodes = rule.nodes(arc.signal_e, arc.may_miss_e, std::max(square(m.slope), square(end)));
  return a;
}

/// Fetches the pixels of a short arc that will be drawn soon: its rows are far apart in memory.
/// Inline, as a function that only fetches is taken for one that does nothing.
[[gnu::always_inline]] inline void prefetch(const ShortArc& a, const PsfTable& psf,
                                            const DepositView& view) {
  if (a.nodes == 0) return;
  const int top = std::clamp(int(std::floor(a.y_px)) + psf.first - 1, 0, view.rows - 1);
  const int bottom = std::min(top + psf.size + 2, view.rows);
  const float* at = view.pixels + std::ptrdiff_t(top) * view.stride + int(a.x_px) + psf.first;
  for (int row = top; row < bottom; ++row, at += view.stride) {
    __builtin_prefetch(at, 1);
    __builtin_prefetch(at + 15, 1);
  }
}

/// Whether all light of what is within a box falls into the frame.
bool is_whole(const ArcExtent& box, const PsfTable& psf, const DepositView& view) {
  return box.left + psf.first >= view.left && box.top + psf.first >= view.top &&
         box.right + psf.first + psf.size <= view.left + view.frame_columns &&
         box.bottom + psf.first + psf.size <= view.top + view.frame_rows;
}

void check(const Arc& arc, std::size_t index) {
  const double sum = std::abs(arc.start.x_px) + std::abs(arc.start.y_px) +
                     std::abs(arc.middle.x_px) + std::abs(arc.middle.y_px) +
                     std::abs(arc.end.x_px) + std::abs(arc.end.y_px) + arc.signal_e;
  if (!(sum < 1e16 && arc.signal_e >= 0.0 && std::abs(arc.tilt) <= 1.0 && arc.may_miss_e >= 0.0))
    throw Error("deposit: arc " + std::to_string(index) + " is not finite or has negative light");
}

}  // namespace

Deposited operator+(const Deposited& a, const Deposited& b) {
  const double sum = a.signal_e + b.signal_e;
  if (!(sum > 0.0)) return {};
  return {sum, (a.x_px * a.signal_e + b.x_px * b.signal_e) / sum,
          (a.y_px * a.signal_e + b.y_px * b.signal_e) / sum};
}

DepositView view_of(ExpectedElectronImage& image) {
  return {.pixels = image.pixels.data(),
          .columns = image.columns,
          .rows = image.rows,
          .stride = image.columns,
          .frame_columns = image.columns,
          .frame_rows = image.rows};
}

DepositView without_border(DepositView view, int border) {
  view.left += border;
  view.top += border;
  view.frame_columns -= 2 * border;
  view.frame_rows -= 2 * border;
  return view;
}

Deposited deposited_in_frame(const Arc& arc, const PsfTable& psf, const DepositView& view) {
  return inside(arc, psf, view);
}

Arc part_of(const Arc& arc, double tau_begin, double tau_end) {
  const Motion m(arc);
  const double length = tau_end - tau_begin;
  const double brightness = 1.0 + arc.tilt * (tau_begin + tau_end - 1.0);
  return {m.at(tau_begin), m.at(0.5 * (tau_begin + tau_end)), m.at(tau_end),
          arc.signal_e * length * brightness,
          brightness > 0.0 ? std::clamp(arc.tilt * length / brightness, -1.0, 1.0) : 0.0};
}

ArcExtent extent(const Arc& arc) { return bounds(Motion(arc), 0.0, 1.0); }

namespace {

/// Arcs of the bands of rows of an image, in order.
struct Bands {
  std::vector<std::vector<std::uint32_t>> of_band;
  std::vector<std::uint32_t> in_many;  // that are in more than one band
  std::vector<ShortArc> short_arc;     // one for each arc
  std::vector<bool> all_inside;        // which arcs need no sums, as all of their light is

  Bands(std::span<const Arc> arcs, const PsfTable& psf, const DepositView& image, DepositSums sums,
        std::vector<Deposited>& result)
      : of_band(std::size_t((image.rows + band_rows - 1) / band_rows)),
        short_arc(arcs.size()),
        all_inside(arcs.size(), false) {
    const ShortArcRule rule(psf);
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      check(arcs[i], i);
      const Motion motion(arcs[i]);
      const ArcExtent box = bounds(motion, 0.0, 1.0);
      if (!box.meets(reach(psf, image, 0, image.rows))) continue;
      short_arc[i] = dmise::short_arc(arcs[i], motion, box, rule, psf, image);
      if (sums == DepositSums::cut && is_whole(box, psf, image)) {
        all_inside[i] = true;
        if (arcs[i].signal_e > 0.0)
          result[i] = {arcs[i].signal_e, arcs[i].middle.x_px, arcs[i].middle.y_px};
      }
      const double last = double(image.rows - 1);
      const auto from = std::size_t(std::clamp(box.top - psf.size, 0.0, last)) / band_rows;
      const auto to = std::size_t(std::clamp(box.bottom + psf.size, 0.0, last)) / band_rows;
      for (std::size_t b = from; b <= to; ++b) of_band[b].push_back(std::uint32_t(i));
      if (from != to) in_many.push_back(std::uint32_t(i));
    }
  }
};

}  // namespace

std::vector<Deposited> deposit(std::span<const Arc> arcs, const PsfTable& psf,
                               const DepositView& image, Threads& threads, SimdLevel level,
                               DepositSums sums) {
  const auto add = kernel_of(level, sse2::add_panel, avx2::add_panel, avx512::add_panel);
  const auto add_short = kernel_of(level, sse2::add_short, avx2::add_short, avx512::add_short);
  const PsfTableView table{psf.weights.data(), psf.phases, psf.first, psf.size, psf.stride};
  std::vector<Deposited> result(arcs.size());
  const Bands bands(arcs, psf, image, sums, result);

  const std::size_t span =
      std::size_t(psf.stride) + std::size_t(widest_panel_sigmas * psf.sigma_px) + 16;
  threads.for_ranges(bands.of_band.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<float> work;
    for (std::size_t b = begin; b < end; ++b) {
      const std::vector<std::uint32_t>& of_band = bands.of_band[b];
      if (of_band.empty()) continue;
      work.resize((2 * panel_nodes + 1) * span);
      const int row_begin = int(b) * band_rows,
                row_end = std::min(image.rows, row_begin + band_rows);
      const BandView band{image.pixels, image.columns, row_begin, row_end, image.stride};
      const ArcExtent box = reach(psf, image, row_begin, row_end);
      auto many = std::lower_bound(bands.in_many.begin(), bands.in_many.end(), of_band.front());
      for (std::size_t k = 0; k < of_band.size(); ++k) {
        const std::uint32_t i = of_band[k];
        constexpr std::size_t ahead = 6;  // arcs
        if (k + ahead < of_band.size()) prefetch(bands.short_arc[of_band[k + ahead]], psf, image);
        while (many != bands.in_many.end() && *many < i) ++many;
        // All of its panels that reach the frame reach this band.
        const bool is_here = many == bands.in_many.end() || *many != i;
        const bool sums_here = is_here && !bands.all_inside[i];
        if (bands.short_arc[i].nodes > 0) {
          add_short(bands.short_arc[i], table, band);
          if (sums_here) result[i] = inside(arcs[i], psf, image);
          continue;
        }
        Inside inside{psf, image};
        for_panels(arcs[i], psf, box, [&](const PanelView& panel) {
          add(panel, table, band, work.data());
          if (sums_here) inside.add(panel);
        });
        if (sums_here) result[i] = inside.sum();
      }
    }
  });

  threads.for_ranges(bands.in_many.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = bands.in_many[k];
      if (!bands.all_inside[i]) result[i] = inside(arcs[i], psf, image);
    }
  });
  return result;
}

double length_px(const Arc& arc) {
  const PixelPosition to = arc.middle - arc.start, from = arc.end - arc.middle;
  return std::hypot(to.x_px, to.y_px) + std::hypot(from.x_px, from.y_px);
}

PixelPosition place(const Arc& arc, double tau) { return Motion(arc).at(tau); }

}  // namespace dmise
