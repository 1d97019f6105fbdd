#include "base/shortened.h"

#include <gtest/gtest.h>

namespace softland {
namespace {

TEST(Shortened, IsTheTextItselfUpToTheLimit) {
  EXPECT_EQ(shortened("", 3), "");
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "abc…");
  EXPECT_EQ(shortened(std::string(10'000, 'x')), std::string(80, 'x') + "…");
}

TEST(Shortened, NeverCutsACharacter) {
  EXPECT_EQ(shortened("aµm", 2), "a…");
  EXPECT_EQ(shortened("aµm", 3), "aµ…");
  EXPECT_EQ(shortened("€€", 5), "€…");
  EXPECT_EQ(shortened("€€", 2), "…");
  EXPECT_EQ(shortened("\x80\x80\x80", 2), "…") << "broken UTF-8";
}

TEST(Shortened, WordsLeaveTheRestOfAMessage) {
  EXPECT_EQ(with_words_shortened(""), "");
  EXPECT_EQ(with_words_shortened(" a  b "), " a  b ");
  EXPECT_EQ(with_words_shortened("--target " + std::string(10'000, 'x') + " must be one"),
            "--target " + std::string(80, 'x') + "… must be one");
  const std::string path(900, '/');
  EXPECT_EQ(with_words_shortened(path), path);
}

}  // namespace
}  // namespace softland
