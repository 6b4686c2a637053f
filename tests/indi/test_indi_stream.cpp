// A stream without a root is divided into its elements wherever its pieces end.
#include "sensors/indi/indi_stream.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

std::vector<IndiElement> elements_of(const std::string& text, std::size_t piece = 1 << 20) {
  IndiStream stream;
  std::vector<IndiElement> elements;
  for (std::size_t at = 0; at < text.size(); at += piece) {
    stream.add(std::string_view(text).substr(at, piece));
    while (auto element = stream.next()) elements.push_back(*element);
  }
  return elements;
}

const std::string session =
    "<?xml version=\"1.0\"?>\n<getProperties version='1.7'/>\n"
    "<newNumberVector device=\"a > b\" name='C'>\n  <oneNumber name='X'>\n 5:30 </oneNumber>\n"
    "<oneNumber name='&lt;&#65;'/></newNumberVector><enableBLOB device='c'>Also</enableBLOB>\r\n";

TEST(IndiStream, DividesWhereverPiecesEnd) {
  for (std::size_t piece = 1; piece < session.size(); ++piece) {
    const auto elements = elements_of(session, piece);
    ASSERT_EQ(elements.size(), 3u) << piece;
    EXPECT_EQ(elements[0].name, "getProperties");
    EXPECT_EQ(elements[0].attribute("version"), "1.7");
    EXPECT_EQ(elements[1].attribute("device"), "a > b");
    ASSERT_EQ(elements[1].parts.size(), 2u);
    EXPECT_EQ(elements[1].parts[0].text, "5:30");
    EXPECT_EQ(elements[1].parts[1].attribute("name"), "<A");
    EXPECT_EQ(elements[2].text, "Also");
  }
}

TEST(IndiStream, RefusesWhatNoClientSends) {
  for (const char* text :
       {"<!DOCTYPE a [<!ENTITY b 'c'>]>", "<a><!-- b --></a>", "<a><![CDATA[b]]></a>", "</a>",
        "<a><b><c/></b></a>", "<a><b><c>", "GET / HTTP/1.1\r\n", "<>", "<a <b/>", "<a></b>",
        "<a b=c/>", "<a><?b?></a>", "<a>\xff</a>"})
    EXPECT_THROW(elements_of(text), BadIndi) << text;
}

TEST(IndiStream, BoundsTheLengthOfAnElement) {
  const std::string text(max_indi_element_bytes - 7, 'x');
  EXPECT_EQ(elements_of("<a>" + text + "</a>").size(), 1u);
  EXPECT_THROW(elements_of("<a>" + text + "x</a>"), BadIndi);
  EXPECT_THROW(elements_of("<a " + std::string(max_indi_element_bytes, ' ')), BadIndi);
  EXPECT_TRUE(elements_of(std::string(10 * max_indi_element_bytes, '\n'), 1000).empty());
}

}  // namespace
}  // namespace dmise
