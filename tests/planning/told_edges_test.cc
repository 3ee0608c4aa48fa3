#include "planning/told_edges.h"

#include <gtest/gtest.h>

namespace planbench {
namespace {

using Settings = std::map<std::string, std::string>;

TEST(ToldEdgesTest, TellWhatSamplesThem) {
  const Settings plain = {{"range", "2"}};
  EXPECT_EQ(DescribeEdges(EdgeCheck::kFixed, 0.02, plain), "fixed at 0.02 m");
  EXPECT_EQ(DescribeEdges(EdgeCheck::kFixed, {}, plain), "fixed");
  EXPECT_EQ(DescribeEdges(EdgeCheck::kCertified, 0.02, plain), "certified");
  EXPECT_EQ(DescribeEdges({}, {}, plain), "as the robot says");
  EXPECT_EQ(SamplingOf(EdgeCheck::kFixed, 0.02, plain).resolution_m, 0.02);
}

TEST(ToldEdgesTest, ARuleOfThePlannersOwnIsNamed) {
  const Settings fraction = {{"longest_valid_segment_fraction", "0.005"}};
  EXPECT_EQ(DescribeEdges(EdgeCheck::kFixed, 0.02, fraction),
            "fixed, own sampling: longest_valid_segment_fraction 0.005");
  EXPECT_EQ(SamplingOf(EdgeCheck::kFixed, 0.02, fraction).resolution_m, std::nullopt);
  const Settings weights = {{"edge_weights", "{lift: 1}"}};
  EXPECT_EQ(DescribeEdges(EdgeCheck::kFixed, 0.05, weights),
            "fixed at 0.05 m, own sampling: edge_weights");
  EXPECT_EQ(SamplingOf(EdgeCheck::kFixed, 0.05, weights).resolution_m, 0.05);
  EXPECT_EQ(DescribeEdges(EdgeCheck::kCertified, 0.02, weights), "certified");
}

}  // namespace
}  // namespace planbench
