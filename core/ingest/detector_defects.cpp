#include "core/ingest/detector_defects.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/base/numeric/quantile.h"
#include "core/base/numeric/rng.h"
#include "core/detection/light/trail_light.h"
#include "core/detection/pixels/background.h"

namespace dmise {
namespace {

constexpr int defect_mesh_px = 64;
constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// First and last column and row, from 0.
struct Section {
  int x0, x1, y0, y1;
};

/// First and last pixel of "from:to" from 1 on, in either order, as pixels from 0.
std::optional<std::pair<int, int>> range_of(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == text.npos) return std::nullopt;
  const auto from = parse_integer(trimmed(text.substr(0, colon)));
  const auto to = parse_integer(trimmed(text.substr(colon + 1)));
  if (!from || !to || *from < 1 || *to < 1) return std::nullopt;
  return std::pair{std::min(*from, *to) - 1, std::max(*from, *to) - 1};
}

/// Parses "[x1:x2,y1:y2]".
std::optional<Section> section_of(const std::string& card) {
  const std::string_view text = trimmed(card);
  const std::size_t comma = text.find(',');
  if (!text.starts_with('[') || !text.ends_with(']') || comma == text.npos) return std::nullopt;
  const auto x = range_of(text.substr(1, comma - 1));
  const auto y = range_of(text.substr(comma + 1, text.size() - comma - 2));
  if (!x || !y) return std::nullopt;
  return Section{x->first, x->second, y->first, y->second};
}

/// A card with the section of a frame that the sky lit, or of overscan.
struct SectionCard {
  const char* key;
  bool is_light = true;
};

/// The columns, or the rows, of an image.
struct Lines {
  int count, length;
  std::size_t step, along;  // between lines, and along one
  std::size_t at(int line, int place) const {
    return std::size_t(line) * step + std::size_t(place) * along;
  }
};

/// The median of a line, and its standard error.
struct LineLevel {
  double level = 0.0, error = HUGE_VAL;
};

LineLevel level_of_line(const Lines& lines, int line, const std::vector<double>& values) {
  constexpr std::size_t least = 32;
  std::vector<double> on;
  for (int k = 0; k < lines.length; ++k)
    if (const double v = values[lines.at(line, k)]; std::isfinite(v)) on.push_back(v);
  if (on.size() < least) return {};
  const double level = median_of(on);
  for (double& v : on) v = std::abs(v - level);
  const double sigma = sigma_of_median * median_of(on);
  // Counts are whole: the median of a sky with less noise than a count is no better than it.
  return {level, 1.2533 * std::max(sigma, 0.5) / std::sqrt(double(on.size()))};
}

/// How many lines from an edge on stand out. `way`: 1 from the first line on, -1 from the last.
int standing_out(const Lines& lines, int way, const std::vector<double>& values) {
  constexpr int widest = 32;
  constexpr double min_errors = 6.0;
  const int width = std::min(widest, lines.count / 8);
  if (width < 4) return 0;
  const auto line_at = [&](int k) { return way > 0 ? k : lines.count - 1 - k; };
  const auto middle_of_lines = [&](int from, int to) {
    std::vector<double> levels;
    for (int k = from; k < to; ++k)
      if (const LineLevel l = level_of_line(lines, line_at(k), values); std::isfinite(l.error))
        levels.push_back(l.level);
    return levels.empty() ? no_value : median_of(std::move(levels));
  };
  const double near = middle_of_lines(width, 2 * width),
               far = middle_of_lines(2 * width, 3 * width);
  const double slope = (near - far) / width, near_middle = 1.5 * width - 0.5;
  for (int k = 0; k < width; ++k) {
    const LineLevel l = level_of_line(lines, line_at(k), values);
    const double led_to = near + slope * (near_middle - k);
    if (std::isfinite(l.error) && !(std::abs(l.level - led_to) > min_errors * l.error)) return k;
  }
  return width;
}

std::size_t leave_out(const Lines& lines, int first, int last, std::vector<double>& values) {
  std::size_t pixels = 0;
  for (int line = first; line <= last; ++line)
    for (int k = 0; k < lines.length; ++k) {
      double& v = values[lines.at(line, k)];
      pixels += std::isfinite(v);
      v = no_value;
    }
  return pixels;
}

/// Marks pixels as without a value, and puts sky there.
void give_sky(const std::vector<std::size_t>& pixels, const Background& sky, Frame& frame) {
  if (frame.unusable.pixels.empty())
    frame.unusable = PixelMask(frame.counts.columns, frame.counts.rows);
  const RngKey key = rng_key(0, "", 0, "hot pixels");
  for (const std::size_t i : pixels) {
    const int x = int(i % std::size_t(frame.counts.columns)),
              y = int(i / std::size_t(frame.counts.columns));
    frame.unusable.pixels[i] = 1;
    const double noise =
        double(sky.sigma_dn(x, y)) * double(normal_of(rng_word(key, std::uint32_t(i), 0)));
    frame.counts.pixels[i] =
        std::uint16_t(std::lround(std::clamp(double(sky.level_dn(x, y)) + noise, 0.0, 65535.0)));
  }
}

/// Adds the pixels of columns (or rows) into which charge flowed from a saturated star: a run of
/// clipped pixels that is narrow but for the star, and the light beyond its ends while it is
/// narrow.
void add_bleeding(const Lines& lines, const Frame& frame, const Background& sky,
                  std::vector<std::size_t>& charge) {
  constexpr int min_run = 10, max_width = 3, min_core = 5;
  constexpr double min_snr = 5.0, narrower = 2.0;
  const auto& pixels = frame.counts.pixels;
  const auto clipped = [&](int line, int place) {
    return line >= 0 && line < lines.count &&
           double(pixels[lines.at(line, place)]) >= frame.header.saturation_dn;
  };
  // Up to `min_core`: wider is wide enough.
  const auto width_at = [&](int line, int place) {
    int first = line, last = line;
    while (last - first + 1 < min_core && clipped(first - 1, place)) --first;
    while (last - first + 1 < min_core && clipped(last + 1, place)) ++last;
    return last - first + 1;
  };
  const auto light_at = [&](int line, int place) {
    const std::size_t i = lines.at(line, place);
    return pixels[i] - double(sky.level_dn(int(i % std::size_t(frame.counts.columns)),
                                           int(i / std::size_t(frame.counts.columns))));
  };
  const auto is_narrow = [&](int line, int place) {
    const std::size_t i = lines.at(line, place);
    const double noise = sky.sigma_dn(int(i % std::size_t(frame.counts.columns)),
                                      int(i / std::size_t(frame.counts.columns)));
    const double beside = std::max(line >= 3 ? light_at(line - 3, place) : 0.0,
                                   line + 3 < lines.count ? light_at(line + 3, place) : 0.0);
    return light_at(line, place) > min_snr * noise + narrower * std::max(beside, 0.0);
  };
  for (int line = 0; line < lines.count; ++line)
    for (int first = 0; first < lines.length; ++first) {
      if (!clipped(line, first)) continue;
      int last = first, core = 0, thin = 0;
      for (; last < lines.length && clipped(line, last); ++last) {
        const int wide = width_at(line, last);
        core = std::max(core, wide);
        thin += wide <= max_width;
      }
      if (last - first >= min_run && core >= min_core && 2 * thin > last - first) {
        for (int k = first; k < last; ++k)
          if (width_at(line, k) <= max_width) charge.push_back(lines.at(line, k));
        for (int k = last; k < lines.length && is_narrow(line, k); ++k)
          charge.push_back(lines.at(line, k));
        for (int k = first - 1; k >= 0 && is_narrow(line, k); --k)
          charge.push_back(lines.at(line, k));
      }
      first = last;
    }
}

}  // namespace

void leave_out_overscan(const StandardCards& cards, int columns, int rows,
                        std::vector<double>& values) {
  const SectionCard kinds[] = {{"TRIMSEC"}, {"DATASEC"}, {"BIASSEC", false}};
  bool is_told = false;
  for (const auto& [key, is_light] : kinds) {
    const auto section = section_of(cards.text(key));
    if (!section || (is_told && !is_light)) continue;
    is_told = true;
    const auto [x0, x1, y0, y1] = *section;
    if (x1 >= columns || y1 >= rows) continue;
    const double share = double(x1 - x0 + 1) * (y1 - y0 + 1) / (double(columns) * rows);
    const double lit = is_light ? share : 1.0 - share;
    if (lit == 1.0 || lit < 0.5) continue;
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x)
        if ((x >= x0 && x <= x1 && y >= y0 && y <= y1) != is_light)
          values[std::size_t(y) * std::size_t(columns) + std::size_t(x)] = no_value;
    cards.assumed(formatted("pixels: those %s %s [%.0f:%.0f,%.0f:%.0f] are not used",
                            is_light ? "outside" : "in", key, x0 + 1.0, x1 + 1.0, y0 + 1.0,
                            y1 + 1.0));
    return;
  }
}

void leave_out_bright_edges(const StandardCards& cards, int columns, int rows,
                            std::vector<double>& values) {
  const auto width = std::size_t(columns);
  const std::pair<const char*, Lines> directions[] = {{"columns", {columns, rows, 1, width}},
                                                      {"rows", {rows, columns, width, 1}}};
  for (const auto& [name, lines] : directions) {
    const int first = standing_out(lines, 1, values), last = standing_out(lines, -1, values);
    std::size_t pixels = leave_out(lines, 0, first - 1, values);
    pixels += leave_out(lines, lines.count - last, lines.count - 1, values);
    if (pixels == 0) continue;
    cards.assumed(
        formatted("pixels: the first %.0f and the last %.0f ", double(first), double(last)) + name +
        " stand out from the sky beside them, and are not used");
  }
}

void leave_out_hot_pixels(double sigma_px, Frame& frame, Threads& threads) {
  constexpr double min_sigma_px = 0.7, sharper = 2.0, min_snr = 8.0, min_excess = 5.0;
  const CountImage& counts = frame.counts;
  if (!(sigma_px >= min_sigma_px) || counts.columns < 3 || counts.rows < 3) return;
  const Background sky(counts, defect_mesh_px, threads);
  const Psf psf(sigma_px);
  const Trail star{.flux_e = 1.0};
  // A pixel's light over the mean of the four beside it: no light of a star is sharper.
  const double max_ratio = sharper * trail_value(star, psf, 0, 0) / trail_value(star, psf, 1, 0);
  const double gain = frame.header.gain_e_per_dn;
  std::vector<std::size_t> hot;
  std::vector<float> level(std::size_t(counts.columns)), sigma(level.size());
  for (int y = 1; y + 1 < counts.rows; ++y) {
    sky.level_row(y, 0, counts.columns, level.data());
    sky.sigma_row(y, 0, counts.columns, sigma.data());
    for (int x = 1; x + 1 < counts.columns; ++x) {
      const double here = double(level[std::size_t(x)]), noise = double(sigma[std::size_t(x)]);
      const double light = counts.at(x, y) - here;
      if (!(light > min_snr * noise)) continue;
      const double beside =
          (counts.at(x - 1, y) + counts.at(x + 1, y) + counts.at(x, y - 1) + counts.at(x, y + 1)) /
              4.0 -
          here;
      const double excess = light - max_ratio * std::max(beside, 0.0);
      const double variance = noise * noise * (1 + max_ratio * max_ratio / 4) +
                              (light + max_ratio * max_ratio / 4 * std::max(beside, 0.0)) / gain;
      if (excess > min_excess * std::sqrt(variance))
        hot.push_back(std::size_t(y) * std::size_t(counts.columns) + std::size_t(x));
    }
  }
  if (hot.empty()) return;
  give_sky(hot, sky, frame);
  frame.notes.assumed.push_back(
      formatted("pixels: %.0f are sharper than light can be (hot pixels, "
                "cosmic rays), and are not used",
                double(hot.size())));
}

void leave_out_bleeding(Frame& frame, Threads& threads) {
  const CountImage& counts = frame.counts;
  const auto width = std::size_t(counts.columns);
  const Background sky(counts, defect_mesh_px, threads);
  std::vector<std::size_t> charge;
  for (const Lines& lines :
       {Lines{counts.columns, counts.rows, 1, width}, Lines{counts.rows, counts.columns, width, 1}})
    add_bleeding(lines, frame, sky, charge);
  if (charge.empty()) return;
  give_sky(charge, sky, frame);
  frame.notes.assumed.push_back(
      formatted("pixels: %.0f have charge that flowed from saturated stars, and are not used",
                double(charge.size())));
}

}  // namespace dmise
