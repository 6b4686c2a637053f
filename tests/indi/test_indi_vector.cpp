// Vectors as the elements of the INDI protocol, version 1.7.
#include "sensors/indi/indi_vector.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "sensors/indi/indi_interest.h"

namespace dmise {
namespace {

IndiVector place(double ra_h) {
  return {"a & \"b\"",
          {"EQ", "Place", "Main", IndiKind::number},
          true,
          IndiState::busy,
          {{"RA", "Right ascension", ra_h, {"%10.6m", 0.0, 24.0, 0.0, 1e-3}}}};
}

TEST(IndiVector, IsDefinedAndSet) {
  const IndiRemark remark{"2018-01-21T00:30:00.000", ""};
  EXPECT_EQ(indi_definition(place(5.5), remark),
            "<defNumberVector device=\"a &amp; &quot;b&quot;\" name=\"EQ\" label=\"Place\" "
            "group=\"Main\" state=\"Busy\" perm=\"rw\" timeout=\"60\" "
            "timestamp=\"2018-01-21T00:30:00.000\">\n"
            "<defNumber name=\"RA\" label=\"Right ascension\" format=\"%10.6m\" min=\"0\" "
            "max=\"24\" step=\"0\">5.5</defNumber>\n</defNumberVector>\n");
  EXPECT_EQ(indi_update(place(0.1), {"2018-01-21T00:30:00.000", "a<b"}),
            "<setNumberVector device=\"a &amp; &quot;b&quot;\" name=\"EQ\" state=\"Busy\" "
            "timeout=\"60\" timestamp=\"2018-01-21T00:30:00.000\" message=\"a&lt;b\">\n"
            "<oneNumber name=\"RA\">0.1</oneNumber>\n</setNumberVector>\n");
  EXPECT_THROW(indi_update(place(std::numeric_limits<double>::quiet_NaN()), remark), Error);
}

// KStars 3.6.2 writes the bytes of the frame's file so, and others with lines or `enclen`.
TEST(IndiVector, BlobsAreOneLine) {
  const IndiVector image{
      "c", {"CCD1", "", "", IndiKind::blob}, false, IndiState::ok, {{"CCD1", ""}}};
  EXPECT_EQ(
      indi_blob_update(image, "foobar", ".fits", {"t", ""}),
      "<setBLOBVector device=\"c\" name=\"CCD1\" state=\"Ok\" timeout=\"60\" "
      "timestamp=\"t\">\n<oneBLOB name=\"CCD1\" size=\"6\" format=\".fits\">Zm9vYmFy</oneBLOB>\n"
      "</setBLOBVector>\n");
}

TEST(IndiVector, SmallChangesAreNotTold) {
  EXPECT_FALSE(is_noticed(place(5.5), place(5.5005)));
  EXPECT_TRUE(is_noticed(place(5.5), place(5.502)));
  IndiVector ok = place(5.5);
  ok.state = IndiState::ok;
  EXPECT_TRUE(is_noticed(place(5.5), ok));
}

// Test vectors of RFC 4648, section 10.
TEST(IndiVector, EncodesBase64) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(IndiInterest, IsWhatWasAskedForAndBlobsWhereEnabled) {
  IndiInterest interest;
  EXPECT_FALSE(interest.wants("a", "X", false));
  interest.ask({"a", ""});
  EXPECT_TRUE(interest.wants("a", "X", false));
  EXPECT_FALSE(interest.wants("b", "X", false));
  EXPECT_FALSE(interest.wants("a", "CCD1", true));
  interest.enable({"a", "CCD1", BlobUse::also});
  EXPECT_TRUE(interest.wants("a", "CCD1", true));
  EXPECT_TRUE(interest.wants("a", "X", false));
  interest.enable({"a", "", BlobUse::only});
  EXPECT_TRUE(interest.wants("a", "CCD1", true));
  EXPECT_FALSE(interest.wants("a", "X", false));
  interest.enable({"a", "", BlobUse::never});
  EXPECT_FALSE(interest.wants("a", "CCD1", true));
}

}  // namespace
}  // namespace dmise
