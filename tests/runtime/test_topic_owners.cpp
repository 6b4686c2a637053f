#include "nodes/runtime/protocol/topic_owners.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dmise {
namespace {

using testing::HasSubstr;

v1::Join joining(const std::string& name, const std::string& topic, const std::string& host = "") {
  v1::Join join;
  join.set_name(name);
  join.set_host(host);
  *(topic.starts_with("truth/") ? join.add_produces_direct() : join.add_produces()) = topic;
  return join;
}

TEST(TopicOwners, LetATopicHaveOnePublisher) {
  TopicOwners owners;
  owners.add(joining("orbit", "state/objects"));
  owners.add(joining("a", "truth/a"));
  EXPECT_THAT(owners.fault_of(joining("zeta", "state/objects")).value_or(""),
              HasSubstr("state/objects is published by orbit"));
  EXPECT_THAT(owners.fault_of(joining("zeta", "truth/a")).value_or(""), HasSubstr("by a"));
  EXPECT_FALSE(owners.fault_of(joining("orbit", "state/objects")));  // its next process
  EXPECT_FALSE(owners.fault_of(joining("zeta", "detection/zeta")));
}

TEST(TopicOwners, LetEachTellOfItsOwnAndAnAgentOfThoseBehindIt) {
  TopicOwners owners;
  owners.add(joining("orbit", "state/objects"));
  owners.add(joining("a", "detection/a", "east"));
  owners.add(joining("b", "detection/b", "west"));
  const auto kept = [&](const std::string& member) {
    v1::Done done;
    for (const char* topic : {"detection/a", "state/objects", "detection/b", "nobody's"})
      done.add_published()->set_topic(topic);
    EXPECT_FALSE(owners.keep_own(member, &done));
    std::vector<std::string> topics;
    for (const auto& tally : done.published()) topics.push_back(tally.topic());
    EXPECT_TRUE(owners.keep_own(member, &done));
    return topics;
  };
  EXPECT_THAT(kept("orbit"), testing::ElementsAre("state/objects"));
  EXPECT_THAT(kept("east"), testing::ElementsAre("detection/a"));
  EXPECT_THAT(kept("west"), testing::ElementsAre("detection/b"));
  EXPECT_THAT(kept(""), testing::IsEmpty());
}

}  // namespace
}  // namespace dmise
