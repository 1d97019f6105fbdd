#include "base/printable.h"

#include <gtest/gtest.h>

namespace softland {
namespace {

TEST(Printable, KeepsTextAsItIs) {
  for (const char* text :
       {"", "plain", "line\n\ttab", "250 \u00b5m, \u03bcm, 0 \u2013 1 \u00d7 \u2265", "\u4e2d\u6587 \U0001F600"})
    EXPECT_EQ(printable(text), text);
  EXPECT_EQ(printable_line("a\n\tb"), "a\\u000a\\u0009b");
}

TEST(Printable, EscapesEverythingThatActsOnATerminal) {
  EXPECT_EQ(printable("\x1b[31m"), "\\u001b[31m");
  EXPECT_EQ(printable(std::string("a\0b\rc\x7f", 6)), "a\\u0000b\\u000dc\\u007f");
  EXPECT_EQ(printable("\u0080\u009b2J\u009f\u00a0"), "\\u0080\\u009b2J\\u009f\u00a0")
      << "a blank that does not break is harmless";
  for (const char* direction : {"\u061c", "\u200e", "\u200f", "\u2028", "\u2029", "\u202a", "\u202e", "\u2066", "\u2069"})
    EXPECT_EQ(printable(direction).substr(0, 2), "\\u") << printable(direction);
}

TEST(Printable, ReplacesWhatIsNotUtf8ByteByByte) {
  const std::string bad = "\uFFFD";
  EXPECT_EQ(printable("\xff"), bad);
  EXPECT_EQ(printable("\x9b"
                      "2J"),
            bad + "2J")
      << "C1 of an eight-bit terminal";
  EXPECT_EQ(printable("\xc0\x9b"), bad + bad) << "a longer form than needed";
  EXPECT_EQ(printable("\xe0\x80\x9b"), bad + bad + bad);
  EXPECT_EQ(printable("\xed\xa0\x80"), bad + bad + bad) << "half of a pair";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), bad + bad + bad + bad) << "beyond Unicode";
  EXPECT_EQ(printable("end\xe2\x82"), "end" + bad + bad);
  EXPECT_EQ(printable("\xe2"
                      "abc"),
            bad + "abc");
}

}  // namespace
}  // namespace softland
