#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "core/astrometry/solve_frame.h"
#include "core/base/error.h"
#include "core/base/files/regular_file.h"
#include "core/base/units.h"
#include "core/ingest/star_trails.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/frames/frame_options.h"
#include "launch/run/star_catalogue_option.h"

namespace dmise {
namespace {

struct SolveOptions {
  std::string frame, catalogue, out;
  bool blind = false, json = false;
  double scale_low_arcsec = 0.0, scale_high_arcsec = 0.0, field_deg = 0.0;
  int threads = 1;
  std::shared_ptr<FrameChoice> choice = std::make_shared<FrameChoice>();
};

/// Width of a frame on the sky at a scale in its middle.
double width_rad(const Frame& frame, double arcsec_per_px) {
  const double height = 0.5 * frame.counts.columns * arcsec_per_px * arcsec;
  const auto half = frame.header.projection.axis_angle_rad(height, 0.0);
  if (!half || 2 * *half > 220 * deg)
    throw ConfigError("--scale-high: wider than any lens, got " + std::to_string(arcsec_per_px));
  return 2 * *half;
}

void set_widths(const SolveOptions& o, const Frame& frame, PlateSearch& search) {
  if (o.field_deg > 0) {
    search.narrowest_rad = o.field_deg / 1.1 * deg;
    search.widest_rad = o.field_deg * 1.1 * deg;
  }
  if (o.scale_low_arcsec > 0) search.narrowest_rad = width_rad(frame, o.scale_low_arcsec);
  if (o.scale_high_arcsec > 0) search.widest_rad = width_rad(frame, o.scale_high_arcsec);
  if (search.narrowest_rad > search.widest_rad)
    throw ConfigError("--scale-low: must not exceed --scale-high, got " +
                      std::to_string(o.scale_low_arcsec) + " and " +
                      std::to_string(o.scale_high_arcsec));
}

void print_text(const FrameSolution& s) {
  const PlateFit& fit = s.plate.fit;
  const auto [ra, dec] = to_spherical(wcs_direction(s.wcs, {s.wcs.crpix_x, s.wcs.crpix_y}));
  std::printf("centre       %.6f %+.6f deg, %.5g arcsec/px%s\n", ra / deg, dec / deg,
              wcs_scale_rad_per_px(s.wcs) / arcsec, fit.model.mirrored() ? ", mirrored" : "");
  std::printf("stars        %d of %zu sources, residual %.3f px rms, log odds %.0f\n", fit.count,
              s.sources, fit.rms_px, s.plate.log_odds);
  std::printf("plate        focal length %.3f +- %.2g px%s, %sdistortion of order %d\n",
              fit.model.focal_length_px,
              fit.free.focal_length ? std::sqrt(fit.variance(3)) * fit.model.focal_length_px : 0.0,
              fit.free.centre ? ", centre" : "", fit.free.radial ? "radial " : "", fit.model.order);
  std::printf("WCS          %.3f px rms, %.3f px at most\n", s.wcs.rms_px, s.wcs.max_px);
  if (!s.zero_point) return;
  const ZeroPoint& z = *s.zero_point;
  std::printf("zero point   %.4f +- %.2g mag of 1 e-/s at B-V = %.2f, %.3f mag rms of %d stars\n",
              z.zero_point_mag, z.sigma(0), ZeroPoint::sunlike_bv, z.rms_mag, z.stars);
  std::printf("colour term  %.4f +- %.2g%s\n", z.colour_term, z.sigma(1),
              z.colour_fitted ? "" : " (not fitted)");
  std::printf("extinction   %.4f +- %.2g mag/airmass%s\n", z.extinction_mag_per_airmass, z.sigma(2),
              z.extinction_fitted ? "" : " (not fitted)");
}

/// Where to write; empty: nowhere. Refuses a file that would not be what its name says, or is the
/// frame itself.
std::string checked_out(const SolveOptions& o) {
  if (o.out.empty()) return "";
  for (const char* ending : {".gz", ".fz", ".bz2"})
    if (o.out.ends_with(ending))
      throw ConfigError("--out: an uncompressed file is written, got " + o.out);
  std::error_code none;
  if (std::filesystem::equivalent(o.frame, o.out, none))
    throw ConfigError("--out: must not be the frame itself, got " + o.out);
  return file_to_write("--out", o.out);
}

void solve(const SolveOptions& o) {
  if (o.catalogue == "none") throw ConfigError("--catalogue: solving takes stars, got none");
  const std::string out = checked_out(o);
  Threads threads(o.threads);
  const Frame frame = read_any_frame(o.frame, *o.choice, threads);
  print_notes(o.frame, frame.notes);
  if (frame.header.shutter_closed())
    throw Error(o.frame + ": " + frame.header.closed_text() + ": there are no stars in it");
  SolveSettings settings{.blind = o.blind};
  set_widths(o, frame, settings.search);
  const auto stars = load_star_catalogue(o.catalogue);
  FrameSolution solution;
  try {
    solution = solve_frame(frame, *stars, settings, threads);
  } catch (const Error& e) {
    throw Error(o.frame + ": " + e.what());
  }
  print_notes(o.frame, solution.notes);
  if (!out.empty()) {
    FrameHeader header = solved_header(frame.header, solution);
    if (frame.header.unknown.has(FrameFact::pointing))
      set_trails_of_solved(frame.counts, threads, header);
    write_frame(out, frame.counts, header);
  }
  if (o.json)
    std::printf("%s\n", to_json(solution, frame.header, frame.notes).c_str());
  else
    print_text(solution);
}

void add_solve_options(CLI::App& command) {
  auto o = std::make_shared<SolveOptions>();
  command.add_option("frame", o->frame, "FITS file of a run, or of any camera")->required();
  add_frame_options(command, o->choice);
  command.add_flag("--blind", o->blind, "use neither the pointing nor the focal length");
  auto* field =
      command.add_option("--field", o->field_deg, "width of the frame [deg], within 10 %")
          ->check(number_between(0.1, 180.0));
  command.add_option("--scale-low", o->scale_low_arcsec, "least scale [arcsec/px]")
      ->check(number_between(1e-3, 1e5))
      ->excludes(field);
  command.add_option("--scale-high", o->scale_high_arcsec, "greatest scale [arcsec/px]")
      ->check(number_between(1e-3, 1e5))
      ->excludes(field);
  add_star_catalogue_option(command, o->catalogue, false);
  command.add_option("--out", o->out,
                     "FITS file of the frame with the solved header, uncompressed");
  command.add_flag("--json", o->json, "print one line of JSON");
  add_threads_option(command, o->threads);
  command.callback([o, field] {
    if (!o->blind && (field->count() || o->scale_low_arcsec > 0 || o->scale_high_arcsec > 0))
      throw ConfigError("--field and --scale-*: take --blind");
    solve(*o);
  });
}

}  // namespace

Command solve_command() {
  return {.group = CommandGroup::frames,
          .summary = "Finds where a frame points, its plate and its zero point from its stars",
          .add_options = add_solve_options};
}

}  // namespace dmise
