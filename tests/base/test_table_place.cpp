#include "core/base/numeric/table_place.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dmise {
namespace {

TEST(TablePlace, IsWithinTheTableWhereverTheNumberIs) {
  const auto expect = [](double at, std::size_t nodes, std::size_t node, double part) {
    const TablePlace place = table_place(at, nodes);
    EXPECT_EQ(place.node, node) << at;
    EXPECT_DOUBLE_EQ(place.part, part) << at;
  };
  expect(0.0, 2, 0, 0.0);
  expect(1.0, 2, 0, 1.0);
  expect(2.25, 5, 2, 0.25);
  expect(3.0, 5, 3, 0.0);
  expect(4.0, 5, 3, 1.0);
  expect(-7.0, 5, 0, 0.0);
  expect(INFINITY, 5, 3, 1.0);
  expect(-INFINITY, 5, 0, 0.0);
}

}  // namespace
}  // namespace dmise
