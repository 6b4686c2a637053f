#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/sim/message.h"
#include "core/sim/state.h"
#include "dmise/v1/own_node.pb.h"

namespace dmise {

/// The program of a model has died or is silent: another process may take its place.
class ProgramLost : public Error {
 public:
  using Error::Error;
};

/// The program of a model has ended by itself.
class ProgramEnded : public Error {
 public:
  using Error::Error;
};

/// A model of the user's that has begun, and what is said with it (docs/wire.md, Own nodes): a
/// program, or a function in this process. All functions throw `Error` for an answer that is not
/// one or says that the model failed, and what the model's `send` and `answer` throw.
class OwnModel {
 public:
  using Frames = std::span<const std::string_view>;

  virtual ~OwnModel() = default;

  struct Stepped {
    ObjectStates states;
    std::uint64_t digest = 0;  // digest of the states as they came
    std::optional<std::string> checkpoint;
  };
  /// Asks for the states of a tick; false after the stop.
  bool ask(const v1::OwnNodeStep& step, const EnvironmentState& environment);
  /// Asks for those of a further tick before it has answered; false if it takes no more.
  bool ask_ahead(const v1::OwnNodeStep& step, const EnvironmentState& environment);
  /// What it says of the first tick that it has not answered; nothing after the stop.
  std::optional<Stepped> stepped();
  /// What it finds in a frame with these counts; nothing after the stop.
  std::optional<v1::OwnNodeFound> find(const v1::OwnNodeFrame& frame, std::string_view counts);
  /// What it observes in an exposure; nothing after the stop. `more`: the frames after the request.
  std::optional<v1::OwnNodeObserved> observe(const v1::OwnNodeObserve& exposure, Frames more);

  struct Tracked {
    TrackSet tracks;
    std::optional<v1::OwnNodePoints> points;
    std::uint64_t digest = 0;  // digest of both as they came
    std::optional<std::string> checkpoint;
  };
  /// What it makes of a tick's exposures; nothing after the stop.
  std::optional<Tracked> track(const v1::OwnNodeTrack& track, Frames exposures);

 protected:
  struct Answer {
    v1::OwnNodeAnswer head;
    std::vector<std::string_view> frames;  // with that of the head
    std::shared_ptr<const void> owner;     // keeps the memory of the frames
  };
  /// The answer in these frames. Throws `Error` for one that is none or says that the model failed.
  static Answer answer_in(std::vector<std::string_view> frames, std::shared_ptr<const void> owner);

  /// Sends a request as soon as it is taken; false after the stop.
  virtual bool send(const v1::OwnNodeRequest& request, Frames more) = 0;
  /// False if no request is taken before the last is answered.
  virtual bool send_ahead(const v1::OwnNodeRequest& request, Frames more) = 0;
  /// The next answer; nothing after the stop.
  virtual std::optional<Answer> answer() = 0;

 private:
  /// Asks, and returns the answer as `heard` does.
  std::optional<Answer> exchange(const v1::OwnNodeRequest& request, Frames more, const char* what,
                                 v1::OwnNodeAnswer::BodyCase wanted, std::size_t frames);
  /// The next answer, which must be of this kind and have this many frames; nothing after the stop.
  /// `what`: that it answers, for messages.
  std::optional<Answer> heard(const char* what, v1::OwnNodeAnswer::BodyCase wanted,
                              std::size_t frames);
};

}  // namespace dmise
