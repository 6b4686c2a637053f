#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clients/cpp/node.h"
#include "dmise/v1/own_node.pb.h"

namespace dmise {

/// Answers the requests of a run with what a model says; knows no socket.
class ActorSession {
 public:
  /// `begins` is called with the seconds between signs of life, before the model is made.
  ActorSession(MakeActor make, std::function<void(double alive_every_s)> begins)
      : make_(std::move(make)), begins_(std::move(begins)) {}

  /// Frames of the answer to the frames of a request; nothing at the run's end. Throws `Error` for
  /// what is no request in its place, and whatever the model throws.
  std::optional<std::vector<std::string>> answer(std::span<const std::string_view> frames);

 private:
  std::vector<std::string> begin(const v1::OwnNodeBegin& begin);
  std::vector<std::string> step(const v1::OwnNodeStep& step, std::string_view environment);

  MakeActor make_;
  std::function<void(double)> begins_;
  v1::OwnNodeBegin begun_;
  ActorTask task_;
  std::unique_ptr<ActorModel> model_;
};

}  // namespace dmise
