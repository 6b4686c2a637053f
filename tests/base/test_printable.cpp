#include "core/base/printable.h"

#include <gtest/gtest.h>

#include <random>

namespace dmise {
namespace {

// ECMA-48: C0 controls are 00 to 1F, DEL is 7F, C1 are U+0080 to U+009F; ESC (1B) and CSI (9B)
// begin what terminals obey. Unicode TR 9: marks of direction are U+061C, U+200E/F, U+202A-E,
// U+2066-9.
TEST(Printable, EscapesWhatATerminalObeys) {
  EXPECT_EQ(printable("a\nb\r\tc"), "a\\nb\\r\\tc");
  EXPECT_EQ(printable("\x1b]0;owned\x07"), "\\x1b]0;owned\\x07");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\x7f"), "\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\x9b31m");
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "evil"),
            "\\u202eevil");
  EXPECT_EQ(printable("\xe2\x80\xa8"), "\\u2028");
  EXPECT_EQ(printable("\xe2\x81\xa6"), "\\u2066");
}

TEST(Printable, KeepsLettersOfAllScripts) {
  for (const char* text : {"OSCAR 7 (AO-7)", "Göttingen", "Ракета", "長征", "100 % {}|\\n"})
    EXPECT_EQ(printable(text), text);
}

// The Unicode Standard, table 3-7: well-formed byte sequences.
TEST(Printable, EscapesBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("\xff"), "\\xff");
  EXPECT_EQ(printable("\xc0\x80"), "\\xc0\\x80");                    // overlong
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
  EXPECT_EQ(printable("\xe2\x80"), "\\xe2\\x80");                    // cut short
}

TEST(Printable, CutsWhatIsLongAndSaysHowLongItWas) {
  EXPECT_EQ(printable(std::string(1 << 20, 'x'), 10), "xxxxxxxxxx... (1048576 bytes)");
  EXPECT_EQ(printable("\xc3\xa9\xc3\xa9\xc3\xa9", 3),
            "\xc3\xa9\xc3\xa9... (6 bytes)");  // whole characters
}

TEST(Printable, OfAnyBytesHoldsNoControlAndNoNewLine) {
  std::mt19937 random(1);
  for (int k = 0; k < 20000; ++k) {
    std::string text(random() % 40, '\0');
    for (char& c : text) c = char(random());
    for (const unsigned char c : printable(text)) ASSERT_TRUE(c >= 0x20 && c != 0x7f);
  }
}

TEST(Printable, KnowsUtf8) {
  for (const char* text :
       {"", "ISS (ZARYA)", "\xc3\xa9t\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x9b\xb0"})
    EXPECT_TRUE(is_utf8(text)) << text;
  for (const char* text : {"\xff", "a\xc3", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80"})
    EXPECT_FALSE(is_utf8(text)) << text;
}

}  // namespace
}  // namespace dmise
