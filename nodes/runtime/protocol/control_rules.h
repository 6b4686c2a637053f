#pragma once
#include <optional>
#include <string>

#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"

// What a control message must be to have a meaning: ticks in range, numbers finite, names that can
// be written in a line. Whoever says otherwise is not listened to.
namespace dmise {

/// Why the message has none; nothing when it has.
std::optional<std::string> fault_of(const v1::NodeMessage& message);
std::optional<std::string> fault_of(const v1::MasterMessage& message);
std::optional<std::string> fault_of(const v1::Grant& grant);
std::optional<std::string> fault_of(const v1::ResendRequest& request);

/// A reason that somebody else gives, fit for a line of a log.
std::string one_line(std::string text);

}  // namespace dmise
