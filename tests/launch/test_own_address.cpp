#include "launch/process/own_address.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace dmise {
namespace {

TEST(OwnAddress, NamesBecomeNumbers) {
  EXPECT_EQ(numeric_address("tcp://localhost:7660"), "tcp://127.0.0.1:7660");
  EXPECT_EQ(numeric_address("tcp://192.0.2.7:0"), "tcp://192.0.2.7:0");
}

TEST(OwnAddress, WhatIsNoNameStays) {
  for (const char* address : {"ipc:///run/dmise", "tcp://*:7660", "tcp://lo:0"})
    EXPECT_EQ(numeric_address(address), address);
}

TEST(OwnAddress, IPv6IsRefused) { EXPECT_THROW(numeric_address("tcp://[::1]:7660"), Error); }

TEST(OwnAddress, ANameThatNobodyKnowsIsAnError) {
  EXPECT_THROW(numeric_address("tcp://nowhere.invalid:7660"), Error);  // RFC 6761
}

TEST(OwnAddress, IsTheOneOnTheWayToThePeer) {
  EXPECT_EQ(address_towards("tcp://127.0.0.1:7660"), "tcp://127.0.0.1:0");
  EXPECT_THROW(address_towards("tcp://localhost:7660"), Error);
  EXPECT_THROW(address_towards("ipc:///run/dmise"), Error);
}

}  // namespace
}  // namespace dmise
