#pragma once
#include "core/effects/effects.h"

// What makes expected electrons of sources and of the sky.
namespace dmise::effect {

inline constexpr EffectFacts extinction{
    "extinction", "the atmosphere dims what is seen from the ground", "0.1 to 0.4 mag an airmass",
    "Kasten & Young 1989, Applied Optics 28, 4735"},
    clouds{"clouds", "clouds dim what is above them", "as if the sky were clear",
           "a map of optical depth that the wind moves"},
    scintillation{"scintillation", "turbulence makes point sources flicker (Young)",
                  "4 % for 0.3 m and 0.1 s at an airmass of 1.5", "Young 1967, AJ 72, 747"},
    shadow{"shadow", "objects are dimmed by the Earth's penumbra and umbra",
           "objects in shadow are drawn fully lit", "two discs: the Sun's and the Earth's"},
    earthshine{
        "earthshine", "sunlight that the Earth throws on objects (off unless asked for)",
        "up to 0.4 of full sunlight on what faces the Earth; all that there is in its shadow",
        "a diffuse Earth, ring by ring", false},
    earth_occultation{"earth_occultation", "the Earth hides what is behind it",
                      "objects and stars behind it are drawn", "line of sight and ellipsoid"},
    stars{"stars", "star background", "no stars", "Debian's star catalogues"},
    objects{"objects", "space objects", "no objects", "diffuse spheres and facets"},
    sky{"sky", "sky background", "no background and no noise of it", "the sum of its parts"},
    airglow{"airglow", "light of the upper atmosphere", "22.4 mag/arcsec2 at the zenith",
            "van Rhijn 1921, Publ. Astr. Lab. Groningen 31"},
    zodiacal_light{"zodiacal_light", "sunlight scattered by dust between the planets",
                   "23.3 mag/arcsec2 at the ecliptic poles, 22 and brighter near the ecliptic",
                   "Leinert et al. 1998, A&AS 127, 1, table 17"},
    faint_starlight{"faint_starlight", "stars below the catalogue's limit",
                    "22.2 to 24.5 mag/arcsec2", "Leinert et al. 1998, A&AS 127, 1, section 10"},
    scattered_moonlight{"scattered_moonlight", "moonlight scattered by the air",
                        "up to 18 mag/arcsec2 at full Moon",
                        "Krisciunas & Schaefer 1991, PASP 103, 1033"},
    twilight{"twilight", "sunlight scattered by the air with the Sun below the horizon",
             "18 mag/arcsec2 with the Sun 10 deg down",
             "Patat et al. 2006, A&A 455, 385; Schaefer 1993, Vistas in Astronomy 36, 311"},
    light_pollution{"light_pollution", "light of lamps scattered by the air",
                    "18 mag/arcsec2 in a city", "a zenith brightness and its rise to the horizon"},
    psf{"psf", "blur of the optics", "light falls on a point of no size",
        "Gaussian, or Fourier optics of the pupil"};

inline constexpr const EffectFacts* lights[] = {&extinction,
                                                &clouds,
                                                &scintillation,
                                                &shadow,
                                                &earthshine,
                                                &earth_occultation,
                                                &stars,
                                                &objects,
                                                &sky,
                                                &airglow,
                                                &zodiacal_light,
                                                &faint_starlight,
                                                &scattered_moonlight,
                                                &twilight,
                                                &light_pollution,
                                                &psf};

}  // namespace dmise::effect
