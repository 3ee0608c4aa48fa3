#include "common/content_hash.h"

#include <gtest/gtest.h>

#include <cctype>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace planbench {
namespace {

std::string HashOf(const std::function<void(ContentHash*)>& add) {
  ContentHash hash;
  add(&hash);
  return hash.HexDigest();
}

template <typename... Values>
std::string HashOfValues(const Values&... values) {
  return HashOf([&](ContentHash* hash) { (hash->Add(values), ...); });
}

TEST(ContentHash, Is32LowerCaseHexadecimalDigits) {
  for (const std::string& digest : {HashOfValues(), HashOfValues(1), HashOfValues("text")}) {
    EXPECT_EQ(digest.size(), 32);
    for (const char c : digest) EXPECT_TRUE(std::isdigit(c) || (c >= 'a' && c <= 'f')) << digest;
  }
}

TEST(ContentHash, SameValuesSameDigest) {
  EXPECT_EQ(HashOfValues(1, 2.5, "x"), HashOfValues(1, 2.5, "x"));
  EXPECT_EQ(HashOfValues(std::string("x")), HashOfValues("x"));
  EXPECT_EQ(HashOfValues(true), HashOfValues(1));
}

TEST(ContentHash, OrderAndTypeCount) {
  EXPECT_NE(HashOfValues(1, 2), HashOfValues(2, 1));
  EXPECT_NE(HashOfValues(1), HashOfValues(1.0));
  EXPECT_NE(HashOfValues(), HashOfValues(0));
  EXPECT_NE(HashOfValues(""), HashOfValues());
}

TEST(ContentHash, TextsAndListsKeepTheirBounds) {
  EXPECT_NE(HashOfValues("ab", "c"), HashOfValues("a", "bc"));
  const std::vector<double> one = {1};
  const std::vector<double> two = {2};
  const std::vector<double> both = {1, 2};
  const std::vector<double> none;
  const auto add_lists = [](const std::vector<double>& a, const std::vector<double>& b) {
    return HashOf([&](ContentHash* hash) {
      hash->Add(std::span<const double>(a));
      hash->Add(std::span<const double>(b));
    });
  };
  EXPECT_NE(add_lists(one, two), add_lists(both, none));
  EXPECT_NE(add_lists(both, none), add_lists(none, both));
}

TEST(ContentHash, DoublesCountToTheLastBitButNotTheSignOfZero) {
  EXPECT_EQ(HashOfValues(0.0), HashOfValues(-0.0));
  EXPECT_NE(HashOfValues(0.1 + 0.2), HashOfValues(0.3));
  EXPECT_NE(HashOfValues(0.0), HashOfValues(std::numeric_limits<double>::denorm_min()));
  EXPECT_NE(HashOfValues(1.0), HashOfValues(-1.0));
}

TEST(ContentHash, DigestMayBeTakenOnTheWay) {
  ContentHash hash;
  hash.Add(1);
  EXPECT_EQ(hash.HexDigest(), HashOfValues(1));
  hash.Add(2);
  EXPECT_EQ(hash.HexDigest(), HashOfValues(1, 2));
}

// Stored digests must stay valid.
TEST(ContentHash, LayoutIsFixed) {
  EXPECT_EQ(HashOfValues(), "99aa06d3014798d86001c324468d497f") << "XXH3-128 of no bytes";
}

}  // namespace
}  // namespace planbench
