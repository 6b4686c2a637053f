#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/column.h"
#include "core/photometry/star_spectrum.h"

namespace dmise {

/// What a catalogue does not give for a star.
enum StarFlag : std::uint8_t {
  star_has_no_colour = 1,         // bv is by spectral class, else `default_star_bv`
  star_has_no_parallax = 2,       // parallax_rad is 0: infinitely far
  star_has_no_proper_motion = 4,  // both motions are 0
};
inline constexpr int star_kind_shift = 4;  // the bits above the flags are its `StarKind`

/// Colour of a star whose catalogue gives neither B-V nor spectral class: the Sun's [mag].
inline constexpr float default_star_bv = 0.65F;

/// Stars in ICRS, structure of arrays. Places are for `epoch_jyear`; motions are of that epoch too.
template <template <class> class Array>
struct StarFields {
  double epoch_jyear = 2000.0;            // Julian year, TT
  Array<std::uint32_t> id;                // the catalogue's own number, else the place in its file
  Array<double> ra_rad;                   // [0, 2 pi)
  Array<double> dec_rad;                  // [-pi/2, pi/2]
  Array<double> pm_ra_cosdec_rad_per_yr;  // along right ascension, on the sky
  Array<double> pm_dec_rad_per_yr;
  Array<double> parallax_rad;  // >= 0
  Array<float> v_mag;          // Johnson V
  Array<float> bv;             // Johnson B-V [mag]
  Array<std::uint8_t> flags;   // StarFlag, or-ed, and StarKind

  StarColour colour(std::size_t i) const { return {bv[i], StarKind(flags[i] >> star_kind_shift)}; }
  std::size_t size() const { return ra_rad.size(); }
  bool operator==(const StarFields&) const = default;
};

/// Calls `use(column, ..)` for each column of one or several sets of stars.
template <class Use, class... Stars>
void for_columns(Use&& use, Stars&... stars) {
  use(stars.id...);
  use(stars.ra_rad...);
  use(stars.dec_rad...);
  use(stars.pm_ra_cosdec_rad_per_yr...);
  use(stars.pm_dec_rad_per_yr...);
  use(stars.parallax_rad...);
  use(stars.v_mag...);
  use(stars.bv...);
  use(stars.flags...);
}

template <class T>
using StarVector = std::vector<T>;

/// A catalogue that is being filled.
using StarCatalogue = StarFields<StarVector>;
/// A finished one, which is shared and not changed.
using StarTable = StarFields<Column>;

/// A table of these stars in their order.
StarTable table_of(StarCatalogue catalogue);

/// One star as a reader finds it, before what is missing gets its stated default.
struct StarRecord {
  std::uint32_t id = 0;
  double ra_rad = 0.0;
  double dec_rad = 0.0;
  std::optional<double> pm_ra_cosdec_rad_per_yr;
  std::optional<double> pm_dec_rad_per_yr;
  std::optional<double> parallax_rad;  // none when <= 0
  double v_mag = 0.0;
  std::optional<double> bv;
  std::string_view spectral_type;  // may be empty
};

/// Kind of a star, by its spectral type and by its absolute magnitude where its parallax is known:
/// dwarfs as red as giants are fainter than 4.5. `bv`: its own or that of its class.
StarKind star_kind(const StarRecord& star, double bv);

/// Appends a star with the defaults of `StarFlag`. Returns null, or what is wrong with the record,
/// which is then left out: places outside the sphere, |magnitude| > 50, motions beyond 100
/// arcsec/yr.
const char* append_star(StarCatalogue& catalogue, const StarRecord& star);

/// V to which a catalogue goes: the faint edge of the half magnitude that holds most stars.
/// Counts grow by half in half a magnitude until stars begin to be missing. -infinity without
/// stars.
double faintest_filled_v_mag(std::span<const float> v_mag);

/// Mean B-V of a main-sequence star of a spectral type such as "K2V" or "A?"; none for classes
/// without one (carbon stars, white dwarfs). Source: Fitzgerald 1970, A&A 4, 234, every fifth
/// subclass.
std::optional<double> bv_of_spectral_type(std::string_view type);

/// Moves the star at `i` along a straight line on the sphere from one epoch to another [Julian
/// years].
void move_star(StarCatalogue& catalogue, std::size_t i, double from_jyear, double to_jyear);

}  // namespace dmise
