#include "core/base/numeric/elliptic.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace dmise {
namespace {

struct Row {
  double m1, part_of_quarter, sn, cn, dn;
};
// Reference: tests/reference/elliptic_values.py, mpmath with 60 digits.
const std::array rows{
    Row{1, 0.1, 0.15643446504023088, 0.98768834059513772, 1.0},
    Row{1, 0.5, 0.70710678118654752, 0.70710678118654752, 1.0},
    Row{1, 0.9, 0.98768834059513773, 0.15643446504023083, 1.0},
    Row{1, -0.75, -0.92387953251128676, 0.38268343236508977, 1.0},
    Row{0.7, 0.1, 0.17030462956408515, 0.98539146188154063, 0.99563994493225909},
    Row{0.7, 0.5, 0.73787978575086889, 0.67493216087267009, 0.91469121922869442},
    Row{0.7, 0.9, 0.98970663732116961, 0.14311104793978291, 0.84032388494718321},
    Row{0.7, -0.75, -0.9352963467999982, 0.35386543157332775, 0.85881675757915507},
    Row{0.1, 0.1, 0.252516347073777, 0.96759262836201671, 0.97088204485120859},
    Row{0.1, 0.5, 0.87163462910095412, 0.49015617241042895, 0.56234132519034909},
    Row{0.1, 0.9, 0.99661192983572377, 0.082247561113472545, 0.32571182842844834},
    Row{0.1, -0.75, -0.976625214808705, 0.21494927261996215, 0.37627499361486372},
    Row{0.001, 0.1, 0.44954753783256767, 0.89325640844534451, 0.89336952277176294},
    Row{0.001, 0.5, 0.98455399545595491, 0.17508120981908798, 0.17782794100389228},
    Row{0.001, 0.9, 0.99987338461461335, 0.015912722561443536, 0.035397196563826304},
    Row{0.001, -0.75, -0.9988333039467877, 0.048291106083253204, 0.057703543182522775},
    Row{1e-10, 0.1, 0.85910610398673598, 0.51179752060041439, 0.5117975206725194},
    Row{1e-10, 0.5, 0.99999500003749969, 0.0031622618488986629, 0.0031622776601683794},
    Row{1e-10, 0.9, 0.99999999985911419, 1.6786054431405625e-5, 1.9538977029157265e-5},
    Row{1e-10, -0.75, -0.99999999211928612, 0.00012554452479376301, 0.00012594216015344358},
    Row{1e-30, 0.1, 0.99848543126195329, 0.055016757062109272, 0.055016757062109272},
    Row{1e-30, 0.5, 0.9999999999999995, 3.1622776601683778e-8, 3.1622776601683794e-8},
    Row{1e-30, 0.9, 1.0, 1.8148751118404646e-14, 1.8176280344388229e-14},
    Row{1e-30, -0.75, -1.0, 3.976353580963582e-12, 3.9763537067069249e-12}};

TEST(Elliptic, JacobiFunctionsAgreeWithMultiprecisionDownToTheLeastComplement) {
  for (const auto& [m1, part, sn, cn, dn] : rows) {
    // u = K part is off by a unit of the last place of K, up to 36.
    const auto got = jacobi_functions(part * carlson_rf(0, m1, 1), m1);
    EXPECT_NEAR(got.sn / sn, 1, 1e-14) << m1 << " " << part;
    EXPECT_NEAR(got.cn / cn, 1, 3e-14) << m1 << " " << part;
    EXPECT_NEAR(got.dn / dn, 1, 3e-14) << m1 << " " << part;
  }
}

TEST(Elliptic, EndsOfTheRange) {
  const auto hyperbolic = jacobi_functions(2.0, 0.0);
  EXPECT_EQ(hyperbolic.sn, std::tanh(2.0));
  EXPECT_EQ(hyperbolic.dn, 1 / std::cosh(2.0));
  EXPECT_EQ(jacobi_functions(1e-200, 0.5).sn, 1e-200);
  EXPECT_EQ(jacobi_functions(0.0, 0.5).cn, 1.0);
  const double quarter = carlson_rf(0, 0.3, 1);
  EXPECT_NEAR(jacobi_functions(quarter, 0.3).cn, 0.0, 1e-15);
  EXPECT_NEAR(jacobi_functions(-quarter, 0.3).dn, std::sqrt(0.3), 1e-15);
  EXPECT_EQ(jacobi_functions(-quarter, 0.3).sn, -1.0);
}

TEST(Elliptic, CarlsonsIntegralAgreesWithMultiprecision) {
  EXPECT_NEAR(carlson_rf(1, 2, 3), 0.7269459354689082, 1e-15);
  EXPECT_NEAR(carlson_rf(0, 1e-30, 1), 35.925070756030576, 1e-14);
  EXPECT_NEAR(carlson_rf(4, 4, 4), 0.5, 1e-16);
}

}  // namespace
}  // namespace dmise
