#include <gtest/gtest.h>

#include "core/base/error.h"
#include "nodes/own/own_node_run.h"

namespace dmise {
namespace {

TEST(OwnRecord, AProgramContinuesAfterItsLastCheckpointOrAtItsFirstCall) {
  OwnRecord said;
  v1::OwnNodeBegin begin;
  for (int call = 0; call < 70; ++call) {
    EXPECT_EQ(said.next(), call);
    const bool wanted = OwnRecord::wants_checkpoint(said.next());
    EXPECT_EQ(wanted, call == 63) << call;
    if (call == 10) {  // it was lost, and has no checkpoint
      said.continue_at(begin);
      EXPECT_EQ(said.next(), 0);
    }
    while (said.next() < call) said.add(std::uint64_t(said.next()), {}, "states");
    said.add(std::uint64_t(call), wanted ? std::optional<std::string>("memory") : std::nullopt,
             "states");
  }
  EXPECT_FALSE(begin.has_checkpoint());
  said.continue_at(begin);
  EXPECT_EQ(said.next(), 64);
  EXPECT_EQ(begin.checkpoint(), "memory");
}

TEST(OwnRecord, AProgramThatWasStartedAgainMustSayTheSame) {
  OwnRecord said;
  v1::OwnNodeBegin begin;
  said.add(1, {}, "states");
  said.add(2, {}, "states");
  said.continue_at(begin);
  said.add(1, {}, "states");
  EXPECT_THROW(said.add(3, {}, "states"), Error);
}

}  // namespace
}  // namespace dmise
