#pragma once
#include <array>

// The flux of debris in low orbits by NASA's engineering model of 1991: Kessler, Reynolds &
// Anz-Meador 1989 (NASA TM-100471) as revised in SSP 30425. It holds to 2000 km of height, and for
// objects on circular orbits. Flux is that on a unit of surface of a body that tumbles at random: a
// quarter of density times relative speed.
namespace dmise {

/// Part of the flux that depends on the size: impacts of objects of this diameter or more
/// [1/m2/s], of any year from 1988 on.
double debris_flux_by_size(double diameter_m, double year);

/// Factor of the flux that depends on the height, (0, 1). The flux of the Sun at 10.7 cm is that of
/// the year before.
double debris_flux_by_height(double height_m, double solar_flux_sfu);

/// Factor of the flux on a spacecraft of this inclination.
inline constexpr double spacecraft_inclination_deg = 45.0;
inline constexpr double spacecraft_inclination_factor = 0.990;

/// Objects in each degree of inclination, from 0 on.
using InclinationCounts = std::array<int, 180>;

/// Density of circular orbits of such inclinations times their speed relative to a circular orbit
/// of another inclination, averaged along that: in units of the density over the whole shell and of
/// the orbital speed. Nodes are uniform. 4 / pi where planes are isotropic (Kessler 1981, Icarus
/// 48, 39, of equal circular orbits).
double encounter_factor(const InclinationCounts& objects, double inclination_rad);

}  // namespace dmise
