#pragma once
#include <optional>
#include <string>

#include "dmise/v1/frame.pb.h"
#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"

// Validity of control messages: ticks in range, finite numbers, printable names. Invalid messages
// are ignored.
namespace dmise {

/// Returns why the message is invalid; empty if it is valid.
std::optional<std::string> fault_of(const v1::NodeMessage& message);
std::optional<std::string> fault_of(const v1::MasterMessage& message);
std::optional<std::string> fault_of(const v1::Grant& grant);
std::optional<std::string> fault_of(const v1::ResendRequest& request);
std::optional<std::string> fault_of(const v1::FrameRequest& request);

}  // namespace dmise
