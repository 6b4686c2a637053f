#include "core/base/text_fields.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

// RFC 4180, sections 2.5 to 2.7.
TEST(CsvField, IsQuotedWhereCsvNeedsIt) {
  EXPECT_EQ(csv_field("ISS (ZARYA)"), "ISS (ZARYA)");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("6\" mirror"), "\"6\"\" mirror\"");
  EXPECT_EQ(csv_field("a\nb"), "\"a\nb\"");
}

TEST(CsvField, ReadsBack) {
  const std::vector<std::string> fields{"a,\"b\"", "", "\"", "plain"};
  std::string line;
  for (const auto& field : fields) line += (line.empty() ? "" : ",") + csv_field(field);
  EXPECT_EQ(csv_fields(line), fields);
}

}  // namespace
}  // namespace dmise
