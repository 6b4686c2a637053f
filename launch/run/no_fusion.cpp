#include "core/base/error.h"
#include "launch/run/make_fusion.h"

// Links to the program that the demonstration builds first, in place of make_fusion.cpp.
namespace dmise {

static constexpr const char* no_fusion =
    "this part of the program has no fusion: ./dmise build makes the whole";

std::unique_ptr<Participant> make_fusion(const Scenario&, const Clock&, const std::string&,
                                         const OwnNodeSettings&, const std::shared_ptr<Tracker>&) {
  throw Error(no_fusion);
}

std::shared_ptr<Tracker> make_recorded_tracker(const Scenario&, const std::string&,
                                               const std::string&) {
  throw Error(no_fusion);
}

}  // namespace dmise
