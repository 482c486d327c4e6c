#include <gtest/gtest.h>

#include "common/nearest_name.hpp"

namespace linescope {
namespace {

// Textbook examples of the distance with swaps of neighbours.
TEST(EditDistance, TextbookValues) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("abcd", "abdc"), 1U) << "a swap is one step";
  EXPECT_EQ(edit_distance("ca", "abc"), 3U) << "optimal string alignment never edits a swapped pair again";
  EXPECT_EQ(edit_distance("same", "same"), 0U);
}

TEST(NearestName, FindsTheNearestAndTheFirstOfEquals) {
  EXPECT_EQ(nearest_name("exposre", {"gain", "exposure", "exposed"}), "exposure");
  EXPECT_EQ(nearest_name("aab", {"aaa", "abb"}), "aaa");
}

TEST(NearestName, SaysNothingWhenNoneIsNear) {
  EXPECT_EQ(nearest_name("banana", {"exposure", "gain"}), std::nullopt);
  EXPECT_EQ(nearest_name("x", {}), std::nullopt);
}

}  // namespace
}  // namespace linescope
