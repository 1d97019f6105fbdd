#include "base/content_key.h"

#include <gtest/gtest.h>

namespace softland {
namespace {

TEST(ContentKey, IsMurmurHash3) {
  // Test vectors of the reference implementation.
  EXPECT_EQ(content_key("").hexadecimal(), "00000000000000000000000000000000");
  EXPECT_EQ(content_key("hello").hexadecimal(), "cbd8a7b341bd9b025b1e906a48ae1d19");
  EXPECT_EQ(content_key("hello, world").hexadecimal(), "342fac623a5ebc8e4cdcbc079642414d");
  EXPECT_EQ(content_key("The quick brown fox jumps over the lazy dog.").hexadecimal(), "cd99481f9ee902c9695da1a38987b6e7");
}

}  // namespace
}  // namespace softland
