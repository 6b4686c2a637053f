#include "core/base/files/text_fields.h"

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

// Reference: OWASP, CSV Injection: cells that begin with = + - @, a tab or a carriage return.
TEST(FormulaFree, PutsAnApostropheBeforeWhatSpreadsheetsCompute) {
  for (const std::string text : {"=HYPERLINK(\"x\")", "+1", "-1", "@SUM(1)", "\t=1", "\r=1"})
    EXPECT_EQ(formula_free(text), "'" + text);
  for (const std::string text : {"", "ISS", "1=1", " =1"}) EXPECT_EQ(formula_free(text), text);
}

TEST(ParseReal, TakesWholeFiniteNumbersAlone) {
  EXPECT_EQ(parse_real("+1.5e3"), 1500.0);
  EXPECT_EQ(parse_real("-.5"), -0.5);
  for (const char* text : {"", "+", "+-5", "++5", " 1", "1 ", "1x", "nan", "inf", "1e400"})
    EXPECT_FALSE(parse_real(text)) << text;
}

TEST(LineReader, CountsLinesEndedByLfOrCrLf) {
  LineReader lines("a \r\n\nb");
  EXPECT_EQ(lines.next(), "a ");
  EXPECT_EQ(lines.next(), "");
  EXPECT_EQ(lines.next(), "b");
  EXPECT_EQ(lines.line(), 3);
  EXPECT_FALSE(lines.next());
}

TEST(AtLine, NamesSourceAndLine) {
  EXPECT_EQ(at_line("some.csv", 7, "times must increase" + got("1\t2")),
            "some.csv:7: times must increase, got \"1?2\"");
}

}  // namespace
}  // namespace dmise
