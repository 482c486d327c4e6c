#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "acquire/camera/natural_order.hpp"

namespace linescope {
namespace {

std::vector<std::string> sorted(std::vector<std::string> names) {
  std::sort(names.begin(), names.end(), [](const auto& a, const auto& b) { return natural_less(a, b); });
  return names;
}

TEST(NaturalOrder, NumbersCountAsNumbers) {
  EXPECT_EQ(sorted({"im10.png", "im2.png", "im0.png", "im1.png"}),
            (std::vector<std::string>{"im0.png", "im1.png", "im2.png", "im10.png"}));
}

TEST(NaturalOrder, PaddedAndUnpaddedMix) {
  EXPECT_EQ(sorted({"a010", "a9", "a008"}), (std::vector<std::string>{"a008", "a9", "a010"}));
}

TEST(NaturalOrder, NumbersOfAnyLength) {
  EXPECT_TRUE(natural_less("f99999999999999999999999", "f100000000000000000000000"));
}

TEST(NaturalOrder, SeveralNumbersFromLeftToRight) {
  EXPECT_EQ(sorted({"run10_2", "run2_10", "run2_9"}),
            (std::vector<std::string>{"run2_9", "run2_10", "run10_2"}));
}

TEST(NaturalOrder, IsAStrictTotalOrder) {
  const std::vector<std::string> names{"", "0", "00", "a", "a0", "a00", "a0b", "a00b", "a1", "b", "10", "9"};
  for (const auto& a : names) {
    for (const auto& b : names) {
      EXPECT_EQ(natural_less(a, b) + natural_less(b, a), a == b ? 0 : 1) << '"' << a << "\" \"" << b << '"';
    }
  }
}

}  // namespace
}  // namespace linescope
