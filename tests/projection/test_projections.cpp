#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/projection/projection.h"
#include "tests/projection/every_pixel.h"

namespace dmise {
namespace {

TEST(Projections, ARowIsFoundByItsNameAndByItsCodeInFits) {
  for (std::size_t i = 0; i < Projection::rows().size(); ++i) {
    const auto& row = Projection::rows()[i];
    EXPECT_EQ(Projection::index_of_name(row.name), i);
    if (row.fits_code) {
      EXPECT_EQ(Projection::index_of_fits_code(row.fits_code), i);
    }
    const std::vector<double> none(row.coefficients.size(), 0.0);
    EXPECT_EQ(Projection::make(i, none).name(), std::string(row.name));
    EXPECT_TRUE(Projection::make(i, none).fits_plane().row().fits_code);
    EXPECT_THROW(Projection::make(i, std::vector<double>(none.size() + 1)), Error);
  }
  EXPECT_FALSE(Projection::index_of_name("orthographic"));
  EXPECT_FALSE(Projection::index_of_fits_code("SIN"));
  EXPECT_THROW(Projection::make(Projection::rows().size(), {}), Error);
}

TEST(Projections, ACoefficientOutOfItsRangeOrNotANumberIsRefused) {
  for (std::size_t i = 0; i < Projection::rows().size(); ++i)
    for (std::size_t k = 0; k < Projection::rows()[i].coefficients.size(); ++k)
      for (const double bad : {1.001 * Projection::rows()[i].coefficients[k].most, double(NAN)}) {
        std::vector<double> values(Projection::rows()[i].coefficients.size(), 0.0);
        values[k] = bad;
        EXPECT_THROW(Projection::make(i, values), Error);
      }
}

TEST(Projections, AreOneToOneAtEveryPixel) {
  using test::camera_of;
  for (const Projection& p : {Projection::gnomonic, Projection::equidistant, Projection::equisolid,
                              Projection::stereographic}) {
    test::expect_one_to_one_at_every_pixel(camera_of(p, 1, 300, 200));
    test::expect_one_to_one_at_every_pixel(camera_of(p, 150, 300, 301));
    if (p != Projection::gnomonic)
      test::expect_one_to_one_at_every_pixel(camera_of(p, 215, 400, 300));
  }
}

}  // namespace
}  // namespace dmise
