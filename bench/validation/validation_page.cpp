#include "bench/validation/validation_page.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/formatted.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double phase_bin_deg = 5.0, widest_mag = 2.5;
constexpr std::size_t max_points = 500, least_in_bin = 10;
constexpr Colour grey{190, 190, 190}, blue{31, 119, 180}, orange{255, 127, 14};

constexpr const char* introduction = R"(# Validation

What the models give beside what the sky gave. `dmise validate` writes this page from measurements that are not part of the
repository (`--data DIR`, else `$DMISE_DATA/validation`), from published figures of the sky that are in the program, and from frames that it draws;
it needs no network. Half of each set of measurements of brightness was not seen by the fit of the model that it judges.
)";

constexpr const char* about_brightness = R"(
## Brightness of families of satellites

A model is a shape with effective surfaces and an attitude law (`dmise list models`, [objects](models/objects.md#models-of-families)). The light of
its facets for the Sun, the observer and the attitude of each measurement is compared with the magnitude that was measured. Single
exposures state height, elevation and azimuth. Light curves state range and phase, and the circular orbit of the family's
inclination that agrees with both says where the satellite was. The exposures are stated as AB magnitudes, of no band;
V is assumed, and they are compared with the AB magnitude of sunlight of the predicted V (the same photons over 3631 Jy). MMT-9's, which are
of no filter and about V, are compared with V itself. All are taken as above the atmosphere.

- **median**, **mean**: measured less predicted; above 0 the model is too bright. A mean below the median is of tracks that are much
  brighter than the others: no model of the family has them.
- **scatter**: the standard deviation about the mean. Satellites of a family differ, so no model of the family brings it to 0.
- **of a phase law**: the scatter that a parabola in phase leaves, fitted to the fitted half alone: what is known without a shape.
- **between tracks**: the standard deviation of the tracks' medians (a track of single exposures is a night).
- **within tracks**: the standard deviation of means over a second about their track's mean, the median over tracks.
- **power of light curves**: the variance of the magnitude at 1000 km about its straight line within a track, in octaves of periods and of all
  from 2 s to the track's length, as mean and median over tracks of at least 16 s. Noise of photons and of the air is white above 1 Hz; its
  level is subtracted. The model's glints are those of 16 seeds, with noise of the same level, which is subtracted too.
  Wanted of all periods of the held-out half: a factor of 2 either way. Few bright flares make most of a mean.

This does not show: satellites or nights that the fit has not seen (many have tracks in both halves of the light curves), colours (all
is in V), glints shorter than two seconds, light below 20 deg of elevation, phases and seasons that were not measured, or satellites with
visors.
)";

ChartAxis axis(const std::string& label, double least, double most, double step) {
  ChartAxis axis{.label = label, .least = least, .most = most};
  for (double at = std::ceil(least / step) * step; at <= most + 1e-9; at += step)
    axis.ticks.push_back({at, formatted("%g", std::abs(at) < 1e-9 ? 0.0 : at)});
  return axis;
}

std::string row(const char* half, const BrightnessFigures& f, bool curves) {
  std::string text = formatted("| %s | %zu | %zu | %+.2f | %+.2f | %.2f | %.2f | %.2f |", half,
                               f.lights, f.tracks, f.median_mag, f.mean_mag, f.scatter_mag,
                               f.phase_law_scatter_mag, f.track_scatter_mag);
  return text + (curves
                     ? formatted(" %.2f, %.2f |\n", f.within_measured_mag, f.within_predicted_mag)
                     : std::string(" |\n"));
}

std::string power_table(const FamilyBrightness& family, const std::string& pictures) {
  std::string text = formatted(
      "\nPower of light curves; the noise of a point is %.3f mag (held-out half, median):\n\n"
      "| half | periods, s | tracks | mean: measured, model, mag2 | ratio | median: measured, "
      "model, mag2 | ratio |\n|---|---|---|---|---|---|---|\n",
      family.held_out_power.white_mag);
  for (const auto& [half, power] :
       {std::pair("fitted", &family.fitted_power), std::pair("held out", &family.held_out_power)})
    for (const auto& b : power->bands) {
      const std::string periods = b.longest_s > 0.0
                                      ? formatted("%g to %g", b.shortest_s, b.longest_s)
                                      : formatted("%g to the length", b.shortest_s);
      text += formatted("| %s | %s | %zu | %.5f, %.5f | %.2f | %.5f, %.5f | %.2f |\n", half,
                        periods.c_str(), b.tracks, b.measured_mean, b.model_mean,
                        b.model_mean / b.measured_mean, b.measured_median, b.model_median,
                        b.model_median / b.measured_median);
    }
  return text + "\n![Mean power of light curves](" + pictures + "/" + family.model +
         "-power.svg)\n";
}

std::string section(const FamilyBrightness& family, const std::string& pictures) {
  const bool curves = family.held_out.within_measured_mag > 0.0;
  std::string text = "\n## " + family.what + "\n\n";
  text += "Model `" + family.model + "` against " + family.source + "; " + family.split + ". ";
  if (family.left_out > 0)
    text += counted(family.left_out, "measurement") + " in penumbra " +
            (family.left_out == 1 ? "is" : "are") + " left out. ";
  if (curves)
    text += formatted("The orbits agree with the ranges to %.2f km rms in the worst track. ",
                      1e-3 * family.worst_rms_m);
  text += formatted(
      "Wanted of the held-out half: a median within %.2f mag, a scatter of at most "
      "%.2f mag%s.\n\n",
      family.target_median_mag, family.target_scatter_mag,
      curves ? ", 1.2 times the phase law's" : "");
  text +=
      "| half | points | tracks | median, mag | mean, mag | scatter, mag | of a phase law, mag | "
      "between "
      "tracks, "
      "mag | within tracks: measured, model, mag |\n|---|---|---|---|---|---|---|---|---|\n";
  text += row("fitted", family.fitted, curves) + row("held out", family.held_out, curves);
  text += "\n![Measured less predicted magnitude by phase](" + pictures + "/" + family.model +
          ".svg)\n";
  return curves ? text + power_table(family, pictures) : text;
}

}  // namespace

Chart difference_chart(const FamilyBrightness& family) {
  Chart chart{.title = family.what,
              .subtitle =
                  "held-out half, measured less predicted magnitude; above 0 the model is "
                  "too bright; points beyond 2.5 mag are not drawn"};
  ChartSeries points{.label = "measurements", .colour = grey},
      middle{.label = "median", .colour = blue}, bounds{.label = "68 %", .colour = orange};
  std::map<int, std::vector<double>> bins;
  std::size_t held_out = 0;
  for (const auto& light : family.lights) held_out += light.held_out;
  const std::size_t every = std::max<std::size_t>(1, held_out / max_points);
  std::size_t k = 0;
  double min_deg = 180.0, max_deg = 0.0;
  for (const auto& light : family.lights) {
    if (!light.held_out) continue;
    const double phase_deg = light.phase_rad / deg;
    min_deg = std::min(min_deg, phase_deg);
    max_deg = std::max(max_deg, phase_deg);
    bins[int(std::floor(phase_deg / phase_bin_deg))].push_back(light.difference_mag());
    if (k++ % every == 0 && std::abs(light.difference_mag()) < widest_mag)
      points.lines.push_back(
          {{phase_deg - 0.15, light.difference_mag()}, {phase_deg + 0.15, light.difference_mag()}});
  }
  middle.lines.emplace_back();
  bounds.lines.resize(2);
  for (const auto& [bin, values] : bins) {
    if (values.size() < least_in_bin) continue;
    const double at = (bin + 0.5) * phase_bin_deg;
    middle.lines[0].push_back({at, median_of(values)});
    bounds.lines[0].push_back({at, quantile_of(values, 0.16)});
    bounds.lines[1].push_back({at, quantile_of(values, 0.84)});
  }
  chart.x = axis("Sun-satellite-observer, deg", std::floor(min_deg / 10) * 10,
                 std::ceil(max_deg / 10) * 10, 20.0);
  chart.y = axis("measured - predicted, mag", -widest_mag, widest_mag, 0.5);
  chart.series = {std::move(points), std::move(bounds), std::move(middle)};
  return chart;
}

std::string validation_page(const std::vector<FamilyBrightness>& families,
                            const std::string& pictures) {
  std::string text = introduction;
  if (!families.empty()) text += about_brightness;
  for (const auto& family : families) text += section(family, pictures);
  return text;
}

}  // namespace dmise
