#include "core/detection/detect.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/detection/curve/light_curve.h"
#include "core/detection/describe.h"
#include "core/detection/frame_scene.h"
#include "core/detection/known/star_motion.h"
#include "core/detection/make_report.h"
#include "core/detection/pixels/background.h"
#include "core/detection/pixels/components.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/source/hidden_ends.h"
#include "core/detection/source/line_profile.h"
#include "core/detection/source/scene.h"
#include "core/detection/source/source_fit.h"
#include "core/detection/source/star_hypothesis.h"
#include "core/detection/source/template_snr.h"
#include "core/detection/stars/alike_streaks.h"
#include "core/detection/stars/hide_stars.h"
#include "core/detection/stars/psf_measure.h"
#include "core/detection/stars/trailed_stars.h"
#include "core/detection/streaks/evenness.h"
#include "core/detection/streaks/faint_ends.h"
#include "core/detection/streaks/faint_streaks.h"
#include "core/detection/streaks/join_flashes.h"
#include "core/detection/streaks/judge_components.h"
#include "core/detection/streaks/neglected_errors.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

/// Hides a component and what its light reaches.
void hide(FilteredFrame& frame, const Component& component, int reach_px) {
  for (const Run& run : component.runs)
    for (int y = run.y - reach_px; y <= run.y + reach_px; ++y)
      frame.hide(y, run.first_x - reach_px, run.last_x + reach_px);
}

void hide(FilteredFrame& frame, const PixelMask& unusable) {
  for (int y = 0; y < frame.rows; ++y)
    for (int x = 0; x < frame.columns; ++x)
      if (unusable.at(x, y)) frame.hide(y, x, x);
}

void hide(FilteredFrame& frame, const BitMask& mask) {
  for (int y = 0; y < frame.rows; ++y)
    mask.for_set(y, 0, frame.columns, [&](int x) { frame.hide(y, x, x); });
}

/// Whether an end of a streak is so near the frame's edge that it may be beyond it.
bool may_leave(const CountImage& counts, const Source& source) {
  const Trail& t = source.trail();
  if (!source.streak) return false;
  const double snr2_per_px = source.snr() * source.snr() / std::max(t.length_px, 1.0);
  const double error_px = std::min(2 * end_error_px(snr2_per_px), t.length_px / 4);
  for (const double half : {-t.length_px / 2, t.length_px / 2}) {
    const auto [x, y] = t.at(half);
    if (std::min({x, y, counts.columns - 1 - x, counts.rows - 1 - y}) < error_px) return true;
  }
  return false;
}

bool before(const Source& a, const Source& b) {
  if (a.snr() != b.snr()) return a.snr() > b.snr();
  if (a.trail().y_px != b.trail().y_px) return a.trail().y_px < b.trail().y_px;
  return a.trail().x_px < b.trail().x_px;
}

/// By falling SNR; sources on a stronger streak are pieces of it.
std::vector<Source> distinct(std::vector<Source> all, double sigma_px) {
  std::vector<Source> out;
  std::sort(all.begin(), all.end(), before);
  for (Source& source : all) {
    const Trail& t = source.trail();
    const double margin_px = !source.beside  ? 3 * sigma_px + 1.5
                             : source.streak ? 1.5 * sigma_px
                                             : 0.0;
    const bool piece = std::ranges::any_of(out, [&](const Source& stronger) {
      const Around of(stronger.trail(), std::max(margin_px, 3 * stronger.broad_sigma_px + 1.5));
      const auto has = [&](double along_px) {
        const PixelPosition at = t.at(along_px);
        return of.has(at.x_px, at.y_px);
      };
      return has(0.0) && (!source.streak || (has(-t.length_px / 4) && has(t.length_px / 4)));
    });
    if (!piece) out.push_back(std::move(source));
  }
  return out;
}

/// A faint streak must also stand out against parallel lines beside it: where several stars share
/// every few pixels, some are aligned by chance. The scatter of stars has a longer tail than pixel
/// noise, so it is weighted higher. Where stars are too few for such a row, those that light a part
/// of a line beside it don't count.
bool is_row_of_stars(const Scene& scene, const Source& source) {
  if (!source.streak) return false;
  const bool is_short = source.trail().length_px < 25;  // longer ones may be structures of the sky
  if (is_short && scene.row_would_be_known(source.trail())) return false;
  const double snr_per_px = source.snr() / std::sqrt(std::max(source.trail().length_px, 1.0));
  if (source.snr() > detection_limits::even_snr && snr_per_px > detection_limits::even_snr_per_px)
    return false;
  const double rise = rise_above_neighbours(scene, source.trail());
  const double noise = 1 / source.snr(), scatter = 1 / rise;  // in units of the streak's light
  const double stars = std::sqrt(std::max(scatter * scatter - noise * noise, 0.0));
  if (rise > 0 && std::hypot(detection_limits::min_snr * noise,
                             detection_limits::min_snr_in_stars * stars) <= 1)
    return false;
  return !is_continuous(scene, source.trail()) ||
         rise_above_neighbours(scene, source.trail(), LineLight::median) <
             detection_limits::min_snr ||
         !is_beyond_stars(scene, source);
}

/// Whether noise may have made a streak: its light is not sure with the errors of its ends and of
/// columns, and the noise of its pixels alone does not exclude it.
bool is_lost_in_its_errors(const Scene& scene, const FrameHeader& header, Source source) {
  if (!source.streak) return false;
  if (header.detector) add_column_noise(source, header.detector->column_noise_e, scene.sigma_px);
  if (source.snr() >= detection_limits::min_published_snr) return false;
  const bool by_pixels = !header.detector && source.snr() >= detection_limits::min_sure_snr;
  return template_snr(scene, source.trail()) <
         (by_pixels ? detection_limits::sure_snr_of_pixels : detection_limits::sure_snr);
}

/// Adds the errors of the ends to a source; false if its light is then not sure.
bool add_errors_of_ends(const Scene& scene, const FrameHeader& header, Source& source) {
  const auto ends = errors_of_faint_ends(scene, source);
  Source seen = source;  // with errors that do not depend on the noise beside its ends
  add_steps_at_ends(seen, scene.sigma_px);
  add_errors_of_hidden_ends(scene, seen);
  if (seen.snr() < detection_limits::min_light_snr) return false;
  add_neglected_errors(source, ends ? &*ends : nullptr);
  if (is_lost_in_its_errors(scene, header, source)) return false;
  if (!ends) add_errors_of_hidden_ends(scene, source);
  return true;
}

std::vector<Component> components_of(const Scene& scene, FilteredFrame& filtered,
                                     Threads& threads) {
  return find_components(scene.counts, scene.background, filtered.sigma_px,
                         detection_limits::connect_snr, detection_limits::seed_snr, threads,
                         &filtered);
}

/// What a search has found, and the sources of its detections.
struct Found {
  DetectionResult result;
  std::vector<Source> sources;
};

/// Detects in a prepared frame. `known`: the stars that were subtracted from it; null: none.
void detect_in(Scene& scene, Background& background, FilteredFrame& filtered,
               const std::vector<Component>& components, const KnownStars* known,
               const FrameHeader& header, const DetectSettings& settings, Threads& threads,
               Found& found) {
  DetectionResult& result = found.result;
  if (known) {
    // Between the stars the background is lower and has less noise.
    background.measure_without(known->lit(), scene.counts, threads);
    filtered.flatten(threads, &known->lit());
    scene.flat = &filtered;
    scene.known = known;
  }
  Judged judged = judge_components(scene, filtered, components, threads);
  for (Source& source : judged.sources) extend(scene, filtered, source);
  judged.star_like += std::uint32_t(std::erase_if(
      judged.sources, [&](const Source& source) { return is_row_of_stars(scene, source); }));
  std::vector<const Component*> parts;  // components that may be parts of faint streaks
  const auto hide_component = [&](const Component& component) {
    const auto& reach_px = judged.reach_px[std::size_t(&component - components.data())];
    if (reach_px) hide(filtered, component, *reach_px);
  };
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (!known && !judged.gave_source[i] && may_be_part_of_streak(components[i]))
      parts.push_back(&components[i]);
    else
      hide_component(components[i]);
  }
  for (const auto& area : background.bent_cells(detection_limits::max_bend_in_noise))
    for (int y = area.y0; y <= area.y1; ++y) filtered.hide(y, area.x0, area.x1);
  if (!known) filtered.flatten(threads);
  for (Source& source : streaks_through(scene, filtered, parts))
    judged.sources.push_back(std::move(source));
  for (const Component* part : parts) hide_component(*part);
  for (Source& source : find_faint_streaks(scene, filtered, threads))
    judged.sources.push_back(std::move(source));
  const std::vector<Source> others = judged.sources;
  for (Source& source : judged.sources)
    source = with_likelier_ends(scene, std::move(source), others);
  judged.sources = with_joined_flashes(scene, std::move(judged.sources));
  result.report = make_report(scene.counts, header, background, scene.psf);
  result.report.star_like = judged.star_like;
  result.report.stars_expected = std::uint32_t(result.stars.expected);
  result.report.stars_found = std::uint32_t(result.stars.found);
  for (Source& source : distinct(std::move(judged.sources), scene.sigma_px)) {
    if (!wcs_sees_sky(header.wcs, {source.trail().x_px, source.trail().y_px})) continue;
    source.at_edge |= may_leave(scene.counts, source);
    if (source.flashes == 0 && !add_errors_of_ends(scene, header, source)) continue;
    if (header.detector) add_column_noise(source, header.detector->column_noise_e, scene.sigma_px);
    std::optional<MeasuredCurve> curve;
    if (settings.light_curves) curve = light_curve_of(scene, source);
    Detection detection = describe(source, header);
    if (curve) describe_light(source, std::move(*curve), header, detection);
    add_detection(std::move(detection), header, result.detections);
    found.sources.push_back(std::move(source));
  }
  result.report.detections = std::uint32_t(result.detections.size());
}

/// Stars that trail. Where few of them were alone, they measure the PSF now.
std::vector<TrailedStar> find_stars_and_psf(Scene& scene) {
  constexpr int enough_stars = 30;
  std::vector<TrailedStar> stars = find_trailed_stars(scene);
  for (int round = 0; round < 2 && scene.psf.stars < enough_stars; ++round) {
    constexpr double little = 0.05, much = 0.2;  // relative change of the width
    const double before_px = scene.psf.width_px;
    std::vector<Trail> trails;
    for (const TrailedStar& star : stars) trails.push_back(star.trail);
    const PsfField psf = measure_psf_of_trails(scene, trails);
    if (psf.stars <= scene.psf.stars) break;
    scene.use(psf);
    const double change = std::abs(psf.width_px / before_px - 1);
    if (change < little && psf.is_round_gaussian()) break;
    auto again = find_trailed_stars(scene);
    if (again.empty()) break;
    stars = std::move(again);
    if (change < much) break;
  }
  return stars;
}

/// Detects in a frame less its stars' trails, which it shows itself. Returns false if there are
/// none or too many to find in bounded time.
bool detect_among_trails(Scene& with_stars, const FrameHeader& header,
                         const DetectSettings& settings, Threads& threads, Found& found) {
  const std::vector<TrailedStar> stars = find_stars_and_psf(with_stars);
  if (stars.empty()) return false;
  StarlessFrame frame = without_stars(with_stars, stars);
  Background background(frame.counts, detection_limits::background_cell_px, threads);
  Scene scene =
      frame_scene(frame.counts, background, with_stars.stars, header, with_stars.unusable);
  scene.use(with_stars.psf);
  FilteredFrame filtered(frame.counts.columns, frame.counts.rows, scene.sigma_px);
  const auto components = components_of(scene, filtered, threads);
  if (scene.unusable) hide(filtered, *scene.unusable);
  hide(filtered, frame.lit);
  std::vector<Trail> subtracted;
  for (const TrailedStar& star : stars) subtracted.push_back(star.trail);
  const KnownStars known(std::move(subtracted), std::move(frame.lit));
  detect_in(scene, background, filtered, components, &known, header, settings, threads, found);
  found.result.report.star_like += std::uint32_t(stars.size());
  return true;
}

bool is_of_unknown_mount(const FrameHeader& header) { return header.mount == "unknown"; }

/// Detects by the motion of stars that a header tells.
Found found_by(const FrameHeader& header, const CountImage& counts, const PixelMask* unusable,
               Threads& threads, const CatalogueSky* sky, const DetectSettings& settings) {
  Background background(counts, detection_limits::background_cell_px, threads);
  const StarMotion stars(header, counts.columns, counts.rows);
  Scene scene = frame_scene(counts, background, stars, header, unusable);
  FilteredFrame filtered(counts.columns, counts.rows, scene.sigma_px);
  const auto components = components_of(scene, filtered, threads);
  scene.use(measure_psf(scene, components));
  scene.sources_per_px2 = double(components.size() + 1) / double(counts.pixels.size());
  if (scene.unusable) hide(filtered, *scene.unusable);
  Found found;
  std::optional<KnownStars> known;
  if (sky) known = hide_stars(scene, filtered, *sky, header, found.result.stars);
  // Where stars trail the frame itself shows them, and more of them than most catalogues have.
  if ((is_of_unknown_mount(header) ? stars_trail(scene) : stars_trail_far(scene)) &&
      detect_among_trails(scene, header, settings, threads, found))
    return found;
  detect_in(scene, background, filtered, components, known ? &*known : nullptr, header, settings,
            threads, found);
  return found;
}

/// Streaks that may be trails of stars, though a header tells of others or of none.
std::optional<AlikeStreaks> unexpected_trails(const FrameHeader& header, const Found& found) {
  constexpr std::size_t most_others = 100;  // sources like stars, for each streak
  if (!is_of_unknown_mount(header)) return std::nullopt;
  auto alike = alike_streaks(found.sources);
  if (alike && found.result.report.star_like > most_others * alike->count) alike.reset();
  return alike;
}

}  // namespace

DetectionResult detect(const CountImage& counts, const FrameHeader& header,
                       const PixelMask* unusable, Threads& threads, const CatalogueSky* sky,
                       const DetectSettings& settings) {
  if (header.shutter_closed()) return without_detection(counts, header);
  Found found = found_by(header, counts, unusable, threads, sky, settings);
  const auto trails = unexpected_trails(header, found);
  if (!trails) return std::move(found.result);
  FrameHeader drifting = header;
  set_even_drift(drifting, trails->trail);
  Found among = found_by(drifting, counts, unusable, threads, sky, settings);
  // Most of what a frame shows is stars: they are what leaves no more objects.
  if (among.result.detections.size() > found.result.detections.size())
    return std::move(found.result);
  among.result.star_trails = trails;
  return std::move(among.result);
}

DetectionResult without_detection(const CountImage& counts, const FrameHeader& header) {
  DetectionResult result{.report = unmeasured_report(counts, header), .detections = {}};
  result.report.detection_off = true;
  return result;
}

}  // namespace dmise
