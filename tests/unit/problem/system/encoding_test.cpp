#include "problem/files/encoding.h"

#include <gtest/gtest.h>

namespace springproof::encoding_test {
namespace {

std::string encoded(const std::string& text) { return base64(text.data(), text.size()); }

TEST(Encoding, Base64HasTheTestVectorsOfRfc4648) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(Encoding, EveryByteComesBackFromBase64) {
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes += static_cast<char>(i);
  for (std::size_t from : {0, 1, 2}) EXPECT_EQ(from_base64(encoded(bytes.substr(from))), bytes.substr(from));
}

TEST(Encoding, ReservedCharactersOfXmlAreEscaped) {
  EXPECT_EQ(xml_escaped("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;");
}

}  // namespace
}  // namespace springproof::encoding_test
