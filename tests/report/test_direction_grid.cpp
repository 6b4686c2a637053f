#include <gtest/gtest.h>

#include "core/base/units.h"
#include "core/report/direction_grid.h"

namespace dmise {
namespace {

Wcs wcs_of(Projection projection, int columns, int rows, double degrees_per_px) {
  return {.projection = projection,
          .crpix_x = 0.5 * (columns - 1),
          .crpix_y = 0.5 * (rows - 1),
          .ra_rad = 359.9 * deg,
          .dec_rad = 89.0 * deg,
          .cd_deg = {-degrees_per_px, 0.0, 0.0, -degrees_per_px}};
}

// Fields over the pole and the wrap of right ascension, as narrow and as wide as cameras have them.
TEST(DirectionGrid, IsRightToATenthOfAPixel) {
  for (const double field_deg : {0.05, 1.0, 20.0, 90.0, 120.0}) {
    const DirectionGrid grid =
        direction_grid(wcs_of(Projection::gnomonic, 2000, 1500, field_deg / 2000), 2000, 1500);
    EXPECT_GT(grid.across, 0);
    EXPECT_LT(grid.error_px, 0.1) << field_deg;
    EXPECT_TRUE(grid.sky.empty());
  }
  // Lenses of 180 deg and more: the corners are at 110 deg from the axis for an equisolid lens.
  for (const Projection& lens :
       {Projection::equidistant, Projection::equisolid, Projection::stereographic}) {
    const DirectionGrid grid = direction_grid(wcs_of(lens, 2000, 2000, 0.066), 2000, 2000);
    EXPECT_LT(grid.error_px, 0.1) << lens.name();
  }
}

TEST(DirectionGrid, IsSmallWhereTheFieldIs) {
  EXPECT_LE(direction_grid(wcs_of(Projection::gnomonic, 4096, 4096, 1e-4), 4096, 4096).across, 4);
}

TEST(DirectionGrid, SaysWhereNoSkyIs) {
  const DirectionGrid grid =
      direction_grid(wcs_of(Projection::equidistant, 400, 400, 1.0), 400, 400);  // a rim at 180 px
  EXPECT_FALSE(grid.sky.empty());
  EXPECT_EQ(grid.sky_across, 96);
}

}  // namespace
}  // namespace dmise
