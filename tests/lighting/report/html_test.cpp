// Pieces of HTML: nothing a user wrote can become mark-up, numbers read as people write them.
#include "lighting/report/html.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sunfleck {
namespace {

TEST(Html, EscapesMarkUpControlCharactersAndBrokenUtf8) {
  EXPECT_EQ(html::escaped("a<b>&\"'"), "a&lt;b&gt;&amp;&quot;&#39;");
  EXPECT_EQ(html::escaped("Fågel été 木 🌳"), "Fågel été 木 🌳");
  EXPECT_EQ(html::escaped(std::string_view("a\0b\x1b", 4)),
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD");
  EXPECT_EQ(html::escaped("\xff\xc3"), "\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(html::escaped("\xc0\xaf"), "\xEF\xBF\xBD\xEF\xBF\xBD");       // overlong
  EXPECT_EQ(html::escaped("\xed\xa0\x80").substr(0, 3), "\xEF\xBF\xBD");  // half of a surrogate pair
}

TEST(Html, NumbersReadAsPeopleWriteThem) {
  EXPECT_EQ(html::number(-1.25, 1), "&minus;1.2");
  EXPECT_EQ(html::number(-0.001, 1), "0.0");
  EXPECT_EQ(html::number(std::nan(""), 1), "&ndash;");
  EXPECT_EQ(html::number_with_error(0.123, 0.004, 1, 100), "12.3&nbsp;&plusmn;&nbsp;0.4");
  EXPECT_EQ(html::number_with_error(0.123, 0.00004, 1, 100), "12.3&nbsp;&plusmn;&nbsp;0.004");
  EXPECT_EQ(html::number_with_error(0.5, 0, 2), "0.50");
  EXPECT_EQ(html::figure(1234567.8), "1&thinsp;234&thinsp;568");
  EXPECT_EQ(html::figure(12.345), "12.35");
  EXPECT_EQ(html::figure(-4321.9), "&minus;4&thinsp;322");
  EXPECT_EQ(html::figure(std::numeric_limits<double>::infinity()), "&ndash;");
  EXPECT_EQ(html::count(341), "341");
  EXPECT_EQ(html::count(50000), "50&thinsp;000");
}

// RFC 4648, section 10.
TEST(Html, Base64OfTheRfc) {
  const char* in[] = {"", "f", "fo", "foo", "foob", "fooba", "foobar"};
  const char* out[] = {"", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
  for (int i = 0; i < 7; ++i) EXPECT_EQ(html::base64(in[i]), out[i]);
}

}  // namespace
}  // namespace sunfleck
