#include "core/ingest/star_trails.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/astrometry/star_sources.h"
#include "core/base/formatted.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"
#include "core/detection/known/star_motion.h"
#include "core/detection/light/psf.h"
#include "core/detection/make_report.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/stars/alike_streaks.h"
#include "core/detection/stars/common_trail.h"
#include "core/frames/earth_orientation.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr double min_fwhm_px = 0.5, max_fwhm_px = 50.0;
constexpr double otherwise_fwhm_px = 2.0;
// A shorter trail looks as coma and astigmatism do, which the PSF follows.
constexpr double min_trail_sigmas = 4.0;
constexpr double min_alike_sigmas = 4.5;  // trails that lines of images measure
constexpr double round_variances = 0.5;   // difference of variances of a round image, of the PSF's

/// A mount at rest: the camera turns with the Earth.
void set_at_rest(FrameHeader& header) {
  const Clock clock(parse_utc(header.middle_utc));
  const EarthOrientation earth = earth_orientation(clock, {});
  const auto camera_from_itrs = rotation_of<CameraFrame, Gcrs>(header.camera_from_gcrs[1]) *
                                earth.itrs_from_gcrs({}).inverse();
  const auto at = [&](double seconds) {
    return quaternion_of(camera_from_itrs * earth.itrs_from_gcrs(sim_seconds(seconds)));
  };
  header.camera_from_gcrs[0] = at(-header.exposure_s / 2);
  header.camera_from_gcrs[2] = at(header.exposure_s / 2);
}

bool may_be_at_rest(const FrameHeader& header) {
  return !header.unknown.has(FrameFact::pointing) && !header.unknown.has(FrameFact::exposure) &&
         !header.unknown.has(FrameFact::time);
}

PixelPosition trail_in_the_middle(const FrameHeader& header, int columns, int rows) {
  return StarMotion(header, columns, rows).trail_at({(columns - 1) / 2.0, (rows - 1) / 2.0});
}

/// Returns whether the width is known, not taken for the usual one.
bool set_width(const StandardCards& cards, const std::optional<StarShape>& shape,
               FrameHeader& header) {
  if (const auto stated = cards.number("PSFFWHM");
      stated && *stated >= min_fwhm_px && *stated <= max_fwhm_px) {
    header.psf_fwhm_px = *stated;
  } else if (shape) {
    const double sigma_px = std::sqrt(std::max(shape->sigma_px * shape->sigma_px - 1.0 / 12, 0.0));
    header.psf_fwhm_px = std::clamp(fwhm_per_sigma * sigma_px, min_fwhm_px, max_fwhm_px);
    cards.assumed(formatted("PSF: %.3g px wide (FWHM), measured in %d stars", header.psf_fwhm_px,
                            shape->stars));
  } else {
    header.psf_fwhm_px = otherwise_fwhm_px;
    cards.assumed("PSF: taken for 2 px wide (FWHM): too few stars to measure it");
    return false;
  }
  return true;
}

/// A median and its standard error.
struct MedianOf {
  double value, error;
};

MedianOf median_and_error(const std::vector<double>& values) {
  const double middle = median_of(values);
  std::vector<double> off;
  for (const double v : values) off.push_back(std::abs(v - middle));
  return {middle, 1.25 * sigma_of_median * median_of(off) / std::sqrt(double(values.size()))};
}

/// Measured elongation over that of a mount at rest.
struct Elongation {
  MedianOf along;  // 1 for such a mount, up to 1.6 for long trails, 0 for stars that do not trail
  MedianOf at_45_deg;  // to its trails, where it has none: 0
};

/// Errors are large where trails are too short to tell.
Elongation elongation_at_rest(const FrameHeader& at_rest, const CountImage& counts,
                              const StarShape& shape) {
  const StarMotion motion(at_rest, counts.columns, counts.rows);
  std::vector<double> along, at_45_deg;
  for (const StarEllipse& e : shape.ellipses) {
    const PixelPosition d = motion.trail_at({e.x_px, e.y_px});
    const double plus = (d.x_px * d.x_px - d.y_px * d.y_px) / 12, cross = d.x_px * d.y_px / 6;
    const double square = plus * plus + cross * cross;
    if (!(square > 1e-6)) continue;
    along.push_back((e.plus * plus + e.cross * cross) / square);
    at_45_deg.push_back((e.cross * plus - e.plus * cross) / square);
  }
  if (along.size() < 5) return {{0.0, 1e9}, {0.0, 1e9}};
  return {median_and_error(along), median_and_error(at_45_deg)};
}

bool is_of_mount_at_rest(const Elongation& e) {
  return e.along.error < 0.15 && e.along.value > 0.6 && e.along.value < 1.8 &&
         std::abs(e.at_45_deg.value) < 0.4 + 3 * e.at_45_deg.error;
}

/// Whether most images are long in one direction, also blends of trails.
bool are_aligned(const StarShape& shape) {
  constexpr double min_agreement = 0.4;  // least length of the mean direction
  double plus = 0.0, cross = 0.0;
  for (const StarEllipse& e : shape.ellipses) {
    const double size = std::hypot(e.plus, e.cross);
    if (size > 0) plus += e.plus / size, cross += e.cross / size;
  }
  return std::hypot(plus, cross) > min_agreement * double(shape.ellipses.size());
}

/// The trail that most edges of light show.
std::optional<PixelPosition> trail_by_edges(const CountImage& counts, const FrameHeader& header,
                                            Threads& threads) {
  const Background background(counts, detection_limits::background_cell_px, threads);
  const StarMotion none(header, counts.columns, counts.rows);
  return common_trail({counts, background, none, header.gain_e_per_dn, lowest_clipped_dn(header),
                       sigma_with_pixel(header.psf_fwhm_px), false,
                       PsfField::gaussian(header.psf_fwhm_px)});
}

/// The trail of most stars by their shapes, if it is significant.
std::optional<PixelPosition> measured_trail(const StarShape& shape) {
  double length_px = shape.length_px, angle_rad = shape.angle_rad;
  if (length_px == 0) {
    std::vector<double> pluses, crosses;
    for (const StarEllipse& e : shape.ellipses) {
      pluses.push_back(e.plus);
      crosses.push_back(e.cross);
    }
    const MedianOf plus = median_and_error(pluses), cross = median_and_error(crosses);
    const double size = std::hypot(plus.value, cross.value);
    const double error = std::hypot(plus.error, cross.error);
    const double scatter = error * std::sqrt(double(pluses.size()));
    length_px = std::sqrt(12 * size);
    angle_rad = 0.5 * std::atan2(cross.value, plus.value);
    // In wide fields trails differ.
    if (length_px < 0.5 || size < 5 * error || scatter > 0.5 * size) return std::nullopt;
  }
  return PixelPosition{length_px * std::cos(angle_rad), length_px * std::sin(angle_rad)};
}

/// The trail that most images agree in by their fitted lines, if no more of them are round.
std::optional<PixelPosition> trail_of_alike(const StarShape& shape) {
  const auto alike = alike_motions(shape.lines);
  const auto round = std::ranges::count_if(shape.ellipses, [&](const StarEllipse& e) {
    return std::hypot(e.plus, e.cross) < round_variances * shape.sigma_px * shape.sigma_px;
  });
  if (!alike || alike->count < std::size_t(round)) return std::nullopt;
  // Lines that are shorter are measured only where noise makes them longer.
  if (std::hypot(alike->trail.x_px, alike->trail.y_px) < min_alike_sigmas * shape.sigma_px)
    return std::nullopt;
  return alike->trail;
}

/// Whether a trail by edges contradicts that of most images: it has another direction, or is
/// shorter. Long trails that touch make images longer or shorter than they are.
bool contradicts(const PixelPosition& edges, const PixelPosition& images, double sigma_px) {
  const double length_px = std::hypot(images.x_px, images.y_px);
  const double along = std::abs(edges.x_px * images.x_px + edges.y_px * images.y_px) / length_px;
  const double across = std::abs(edges.x_px * images.y_px - edges.y_px * images.x_px) / length_px;
  return across > std::max(2 * sigma_px, 0.1 * along) || along < length_px - 2 * sigma_px;
}

std::string trail_text(const PixelPosition& trail) {
  return formatted("stars trail by %.3g px at %.1f deg to the rows",
                   std::hypot(trail.x_px, trail.y_px), std::atan2(trail.y_px, trail.x_px) / deg);
}

/// Finds by the stars whether the mount is at rest, drifts evenly or follows them.
void measure_attitudes(const StandardCards& cards, const CountImage& counts, const StarShape& shape,
                       Threads& threads, FrameHeader& header) {
  if (may_be_at_rest(header)) {
    FrameHeader at_rest = header;
    set_at_rest(at_rest);
    if (is_of_mount_at_rest(elongation_at_rest(at_rest, counts, shape))) {
      header = std::move(at_rest);
      const auto trail = trail_in_the_middle(header, counts.columns, counts.rows);
      cards.assumed("mount: at rest: " + trail_text(trail) + ", as the Earth turns");
      return;
    }
  }
  // Fits of single images are more exact as long as few trails touch.
  constexpr double short_in_widths = 12.0;
  const bool is_short = shape.length_px > 0 && shape.length_px < short_in_widths * shape.sigma_px;
  std::optional<PixelPosition> trail;
  if (!is_short && are_aligned(shape)) trail = trail_by_edges(counts, header, threads);
  const auto alike = trail_of_alike(shape);
  if (alike && (!trail || contradicts(*trail, *alike, shape.sigma_px))) trail = alike;
  if (!trail) trail = measured_trail(shape);
  if (trail && std::hypot(trail->x_px, trail->y_px) < min_trail_sigmas * shape.sigma_px) {
    cards.assumed(
        formatted("mount: turns with the stars, whose images are %.2g px longer than wide",
                  std::hypot(trail->x_px, trail->y_px)));
    return;
  }
  if (!trail) {
    cards.assumed("mount: turns with the stars, which do not trail");
    return;
  }
  set_even_drift(header, *trail);
  cards.assumed("mount: drifts evenly: " + trail_text(*trail));
}

void set_attitudes(const StandardCards& cards, const CountImage& counts,
                   const std::optional<StarShape>& shape, Threads& threads, FrameHeader& header) {
  const std::string stated = cards.text("MOUNT");
  header.mount = "unknown";
  if (stated == "sidereal" || (stated == "fixed" && may_be_at_rest(header))) {
    header.mount = stated;
    if (stated == "fixed") set_at_rest(header);
  } else if (shape) {
    measure_attitudes(cards, counts, *shape, threads, header);
  } else {
    cards.assumed("mount: taken to turn with the stars: too few to measure it");
  }
}

std::optional<StarShape> shape_of(const CountImage& counts, const FrameHeader& header,
                                  Threads& threads) {
  return measure_star_shape(
      counts,
      {.gain_e_per_dn = header.gain_e_per_dn,
       .saturation_dn = header.saturation_dn - 5 * header.read_noise_e / header.gain_e_per_dn},
      threads);
}

}  // namespace

bool set_star_images(const StandardCards& cards, const CountImage& counts, Threads& threads,
                     FrameHeader& header) {
  const auto shape = shape_of(counts, header, threads);
  const bool knows_width = set_width(cards, shape, header);
  set_attitudes(cards, counts, shape, threads, header);
  return knows_width;
}

void set_trails_of_solved(const CountImage& counts, Threads& threads, FrameHeader& solved) {
  solved.camera_from_gcrs.fill(solved.camera_from_gcrs[1]);
  FrameNotes unused;
  const FitsValues stated = {{"MOUNT", solved.mount}};
  set_attitudes(StandardCards(stated, unused), counts, shape_of(counts, solved, threads), threads,
                solved);
}

}  // namespace dmise
