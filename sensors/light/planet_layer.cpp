#include "sensors/light/planet_layer.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/optics/blur/snapshots.h"
#include "core/optics/projection.h"
#include "core/photometry/star_light.h"
#include "sensors/light/row_window.h"
#include "sensors/scene/seen_planet.h"
#include "sensors/scene/spectra.h"
#include "sensors/scene/throughput.h"

namespace dmise {
namespace {

/// Start, middle and end of an exposure, with what its planets have in common.
struct PlanetExposure {
  const View& view;
  FrameTimes all = view.times_of_all_rows();
  std::array<SimTime, 3> instants{all.start, all.middle, all.end};
  StarLight light{view.sensor().camera.band};
  Throughput throughput{view};
  std::optional<Spectra> spectra = Spectra::over(view);

  /// Electrons of a planet over the exposure, behind the air and before vignetting.
  double signal_e(Planet planet, const SeenPlanet& seen) const {
    const double bv = facts_of(planet).bv;
    return light.photons_per_s_m2(seen.v_mag, bv) * throughput.electrons_per_photon_m2() *
           view.times().seconds() * throughput.of_sunlight(seen.apparent, bv);
  }
};

/// A planet's way over the detector, as a point.
struct PlanetTrail {
  std::array<SeenPlanet, 3> seen;
  std::array<Vec<Gcrs>, 3> apparent;  // directions of the middle of its light
  std::array<PixelPosition, 3> pixel;
};

std::optional<PlanetTrail> trail_of(const PlanetExposure& exposure, Planet planet) {
  const View& view = exposure.view;
  PlanetTrail trail;
  for (std::size_t k = 0; k < 3; ++k) {
    const SimTime t = exposure.instants[k];
    const SeenPlanet& seen = trail.seen[k] = seen_planet(view, planet, t);
    trail.apparent[k] = photocentre(planet, seen.apparent, seen.from_sun_m, seen.from_observer_m);
    const auto pixel =
        project(view.sensor().camera.optics, view.camera_from_gcrs(t) * trail.apparent[k]);
    if (!pixel) return std::nullopt;
    trail.pixel[k] = *pixel;
  }
  const auto earth = view.earth_occultation(view.times().middle);
  if (earth && earth->hides_direction(trail.apparent[1])) return std::nullopt;
  return trail;
}

/// The arc of a planet, or those of its spectrum where the air disperses it.
std::vector<Arc> arcs_of(const PlanetExposure& exposure, Planet planet, const PlanetTrail& trail,
                         const Arc& arc) {
  if (!exposure.spectra) return {arc};
  const View& view = exposure.view;
  Arc blue, red;
  PixelPosition* const of_blue[] = {&blue.start, &blue.middle, &blue.end};
  PixelPosition* const of_red[] = {&red.start, &red.middle, &red.end};
  for (std::size_t k = 0; k < 3; ++k) {
    const SimTime t = exposure.instants[k];
    const SpectrumEnds ends = exposure.spectra->ends(
        trail.apparent[k], Refraction::star, view.up(t), view.camera_from_gcrs(t), trail.pixel[k]);
    *of_blue[k] = ends.blue;
    *of_red[k] = ends.red;
  }
  std::vector<Arc> arcs;
  exposure.spectra->add(arc, blue, red, trail.apparent[1], facts_of(planet).bv, arcs);
  return arcs;
}

}  // namespace

void draw_planet_points(const View& view, OpticsStage& optics, const OcclusionMask& mask,
                        ExpectedElectronImage& image, std::vector<StarTruth>* truth) {
  const PlanetExposure exposure{.view = view};
  const int snapshots = view.sensor().effects.snapshots();
  for (const Planet planet : view.planets()) {
    const auto trail = trail_of(exposure, planet);
    if (!trail) continue;
    const auto& [start, middle, end] = trail->pixel;
    Arc arc{start, middle, end,
            exposure.signal_e(planet, trail->seen[1]) * view.illumination(middle)};
    if (view.rolls()) arc = rolled(view, arc);
    Deposited inside;
    if (is_drawn_as_disc(view, trail->seen[1])) {
      if (in_frame(view.sensor().camera.optics, arc.middle))
        inside = {arc.signal_e, arc.middle.x_px, arc.middle.y_px};
    } else {
      std::vector<Arc> arcs = arcs_of(exposure, planet, *trail, arc);
      if (snapshots) arcs = as_snapshots(arcs, snapshots);
      for (const Deposited& part : optics.add(mask.empty() ? arcs : mask.past(arcs), image))
        inside = inside + part;
    }
    if (truth && inside.signal_e > 0.0)
      truth->push_back({planet_bit | std::uint64_t(planet), trail->seen[1].v_mag,
                        facts_of(planet).bv, inside.x_px, inside.y_px, inside.signal_e, arc.start,
                        arc.middle, arc.end});
  }
}

void add_planet_facts(const View& view, PlanFacts& f) {
  f.scene.planets_in_field = !view.planets().empty();
  if (!f.scene.planets_in_field) return;
  constexpr double fastest_c = 2e-4;  // Mercury at perihelion, in units of the speed of light
  const PlanetExposure exposure{.view = view};
  for (const Planet planet : view.planets()) {
    const SeenPlanet seen = seen_planet(view, planet, view.times().middle);
    f.stars += 1.0;
    f.brightest_star_e = std::max(f.brightest_star_e, exposure.signal_e(planet, seen));
  }
  f.light_time_rad = std::max(f.light_time_rad, fastest_c);
}

}  // namespace dmise
