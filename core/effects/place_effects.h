#pragma once
#include "core/effects/effects.h"

// What leads from the place of a thing to the direction from which its light is seen.
namespace dmise::effect {

inline constexpr EffectFacts proper_motion{
    "proper_motion", "stars move from their catalogue's epoch to the date",
    "up to 10.4 arcsec a year (Barnard's star)", "IAU SOFA, eraPmpx"},
    parallax{"parallax", "stars seen from the Earth's place on its orbit", "up to 0.77 arcsec",
             "IAU SOFA, eraPmpx"},
    light_deflection{"light_deflection", "the Sun's gravity bends starlight",
                     "4 mas at 90 deg from the Sun", "IAU SOFA, eraLdsun"},
    annual_aberration{"annual_aberration", "the Earth's motion displaces stars",
                      "up to 20.5 arcsec", "IAU SOFA, eraAb"},
    diurnal_aberration{"diurnal_aberration",
                       "the observer's geocentric motion displaces everything",
                       "0.32 arcsec on the ground, 5.2 in a low orbit", "IAU SOFA, eraAb"},
    light_time{"light_time", "objects are seen where they were when the light left",
               "up to 5.2 arcsec", "three iterations of range / c"},
    refraction{"refraction", "the atmosphere lifts what is seen from the ground",
               "58 arcsec at 45 deg elevation, 5.3 arcmin at 10",
               "IAU SOFA, eraRefco; Bennett 1982, J. Navigation 35, 255"};

inline constexpr const EffectFacts* places[] = {
    &proper_motion,      &parallax,   &light_deflection, &annual_aberration,
    &diurnal_aberration, &light_time, &refraction};

}  // namespace dmise::effect
