#include "core/effects/effects.h"

namespace dmise {
namespace {

constexpr std::array<EffectFacts, effect_count> table{{
    {"proper_motion", "stars move from their catalogue's epoch to the date",
     "up to 10.4 arcsec a year (Barnard's star)"},
    {"parallax", "stars seen from the Earth's place on its orbit", "up to 0.77 arcsec"},
    {"light_deflection", "the Sun's gravity bends starlight", "4 mas at 90 deg from the Sun"},
    {"annual_aberration", "the Earth's motion displaces stars", "up to 20.5 arcsec"},
    {"diurnal_aberration", "the observer's geocentric motion displaces everything",
     "0.32 arcsec on the ground, 5.2 in a low orbit"},
    {"light_time", "objects are seen where they were when the light left", "up to 5.2 arcsec"},
    {"refraction", "the atmosphere lifts what is seen from the ground",
     "58 arcsec at 45 deg elevation, 5.3 arcmin at 10"},
    {"extinction", "the atmosphere dims what is seen from the ground", "0.1 to 0.4 mag an airmass"},
    {"clouds", "clouds dim what is above them", "as if the sky were clear"},
    {"scintillation", "turbulence makes point sources flicker (Young)",
     "4 % for 0.3 m and 0.1 s at an airmass of 1.5"},
    {"shadow", "objects are dimmed by the Earth's penumbra and umbra",
     "objects in shadow are drawn fully lit"},
    {"earthshine", "sunlight that the Earth throws on objects (off unless asked for)",
     "up to 0.4 of full sunlight on what faces the Earth; all that there is in its shadow"},
    {"earth_occultation", "the Earth hides what is behind it",
     "objects and stars behind it are drawn"},
    {"stars", "star background", "no stars"},
    {"objects", "space objects", "no objects"},
    {"sky", "sky background", "no background and no noise of it"},
    {"airglow", "light of the upper atmosphere", "22.4 mag/arcsec2 at the zenith"},
    {"zodiacal_light", "sunlight scattered by dust between the planets",
     "23.3 mag/arcsec2 at the ecliptic poles, 22 and brighter near the ecliptic"},
    {"faint_starlight", "stars below the catalogue's limit", "22.2 to 24.5 mag/arcsec2"},
    {"scattered_moonlight", "moonlight scattered by the air", "up to 18 mag/arcsec2 at full Moon"},
    {"twilight", "sunlight scattered by the air with the Sun below the horizon",
     "18 mag/arcsec2 with the Sun 10 deg down"},
    {"light_pollution", "light of lamps scattered by the air", "18 mag/arcsec2 in a city"},
    {"psf", "blur of the optics", "light falls on a point of no size"},
    {"prnu", "every pixel responds to light a little differently",
     "a fixed pattern: 0.01 of the light in a usual camera"},
    {"photon_noise", "photons arrive at random (Poisson)", "expected electrons instead of a draw"},
    {"dark_current", "electrons that no light freed", "none"},
    {"hot_pixels", "some pixels have far more dark current than the rest", "no false points"},
    {"cosmic_rays", "charged particles leave tracks", "no false points and streaks"},
    {"reference_pixels", "a border that sees neither light nor dark current",
     "the border sees as the rest does"},
    {"persistence", "charge trapped in one exposure appears in the next ones",
     "no ghosts: 1e-3 to 1e-2 of what was collected"},
    {"full_well", "a pixel holds so many electrons and no more", "no saturation before the ADC"},
    {"blooming", "charge above the full well runs along the column", "it is lost"},
    {"interpixel_coupling", "a pixel's signal is seen by its neighbours",
     "noise of neighbours uncorrelated; shot noise looks 1 - 8 times the coupling smaller with it"},
    {"nonlinearity", "the amplifier loses a share of large signals", "a straight response"},
    {"column_noise", "every column is read with an offset, new in each frame", "none"},
    {"read_noise", "noise of the read-out amplifier", "none"},
    {"quantisation", "gain, bias, ADC range and rounding", "one DN an electron, no bias, 16 bits"},
}};

}  // namespace

const EffectFacts& facts(Effect effect) { return table[static_cast<std::size_t>(effect)]; }

std::optional<Effect> effect_named(std::string_view name) {
  for (std::size_t i = 0; i < effect_count; ++i)
    if (table[i].name == name) return static_cast<Effect>(i);
  return std::nullopt;
}

}  // namespace dmise
