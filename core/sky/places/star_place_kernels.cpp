#include "core/sky/places/star_place_kernels.h"

#include "core/base/numeric/lanes.h"

namespace dmise::DMISE_SIMD {

void move_stars(const CatalogueMotion& m, const StarArrays& stars, std::size_t count) {
  for (std::size_t i = 0; i < count; i += wide_lanes) {
    const F64 x = load<F64>(stars.x + i), y = load<F64>(stars.y + i), z = load<F64>(stars.z + i);
    const F64 per_axis = 1.0 / sqrt(x * x + y * y);
    const F64 east_x = -y * per_axis, east_y = x * per_axis;
    const F64 north_x = -(z * east_y), north_y = z * east_x, north_z = x * east_y - y * east_x;
    // The light also has to come in from the star's side to the observer.
    const F64 years =
        m.moves * (m.years + (x * m.light_years[0] + y * m.light_years[1] + z * m.light_years[2]));
    const F64 along_east = years * load<F64>(stars.pm_ra_cosdec_rad_per_yr + i);
    const F64 along_north = years * load<F64>(stars.pm_dec_rad_per_yr + i);
    const F64 parallax = load<F64>(stars.parallax_rad + i);
    const F64 to_x = x + (along_east * east_x + along_north * north_x) - parallax * m.au[0];
    const F64 to_y = y + (along_east * east_y + along_north * north_y) - parallax * m.au[1];
    const F64 to_z = z + along_north * north_z - parallax * m.au[2];
    const F64 per_length = 1.0 / sqrt(to_x * to_x + to_y * to_y + to_z * to_z);
    store(stars.x + i, to_x * per_length);
    store(stars.y + i, to_y * per_length);
    store(stars.z + i, to_z * per_length);
  }
}

}  // namespace dmise::DMISE_SIMD
