#include "core/config/node_names.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

TEST(NodeNames, WhatTheRunItselfUsesIsTakenInAnyCase) {
  for (const char* name :
       {"time-master", "broker", "orbit-node", "environment-node", "positions-node", "fusion-node",
        "operator", "host-agent", "logs", "positions", "rings", "gateway", "export", "Operator",
        "LOGS", "Positions", "Time-Master"})
    EXPECT_TRUE(NodeNames().fault_of(name)) << name;
}

TEST(NodeNames, TwoThatDifferInCaseAloneAreOneOnSomeFileSystems) {
  NodeNames names;
  EXPECT_FALSE(names.fault_of("alpha"));
  EXPECT_FALSE(names.fault_of("beta"));
  EXPECT_EQ(names.fault_of("alpha"), "another node has this name");
  EXPECT_EQ(names.fault_of("Alpha"),
            "another node has this name but for upper and lower case: alpha");
}

// POSIX.1-2017, 12.2, guideline 4: what begins with - is an option. 3.282: the portable characters
// of file names.
TEST(NodeNames, ArePortableNamesOfFilesAndNoOptions) {
  for (const char* name : {"a", "A-1", "omnissa_2", "7", "_", "a-"})
    EXPECT_FALSE(fault_of_name(name)) << name;
  for (const char* name :
       {"", "-", "-a", "--force", ".", "..", "a/b", "a b", "a\nb", "\x1b[m", "é"})
    EXPECT_TRUE(fault_of_name(name)) << name;
  EXPECT_FALSE(fault_of_name(std::string(64, 'x')));
  EXPECT_TRUE(fault_of_name(std::string(65, 'x')));
}

}  // namespace
}  // namespace dmise
