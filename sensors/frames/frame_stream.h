#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/dataset/object_mask.h"
#include "nodes/own/own_function.h"
#include "sensors/frames/make_frames.h"

namespace dmise {

/// A scenario as a stream reads it; `scene` is called in the stream's thread.
struct StreamSource {
  std::shared_ptr<const Scenario> scenario;
  std::function<ScenarioInputs()> scene;
  std::string digest;  // names the run in headers
};

struct StreamOptions {
  std::vector<std::string> sensors;
  int threads = 1;
  bool layers = false;  // expected electrons of stars, objects and sky, and masks of objects
};

/// A frame that was made for a stream.
struct StreamedFrame {
  FrameProducts products;
  // With layers:
  ExpectedElectronImage objects;  // light of all objects [e-]
  LabelImage labels;              // k: the brightest light is of the k-th truth, from 1
};

/// What a stream asks the model of a node: see `FunctionRequest`.
struct ModelRequest {
  std::string node, sensor;
  std::vector<std::string> frames;
};

/// Frames of a scenario, one at a time: a thread of its own makes the next when it is asked for.
/// At most one frame is in memory. It may be used by one thread at a time, of the process that
/// made it. Models of the scenario's nodes run in the thread that waits for a frame.
class FrameStream {
 public:
  FrameStream(StreamSource source, StreamOptions options);
  /// Ends the thread: within the loop over an image that it is in. Does not wait for it.
  ~FrameStream();
  FrameStream(const FrameStream&) = delete;
  FrameStream& operator=(const FrameStream&) = delete;

  /// Asks for the next frame. Throws `Error` in a process forked from that of the stream.
  void ask();
  /// Returns whether what was asked for is there, or a request to a model, or waits that long.
  bool wait(std::chrono::milliseconds time);
  /// Returns the request to a model that was waited for; none if the frame was.
  std::optional<ModelRequest> request() const;
  /// Answers it by the frames of an answer.
  void answer(std::vector<std::string> frames);
  /// Returns what there is to say of the models so far, once: lines.
  std::vector<std::string> take_notes();
  /// Returns the frame that was waited for; null after the last. Throws what making it threw, once.
  std::unique_ptr<StreamedFrame> take();
  /// Ends it: there are no more frames.
  void stop();

 private:
  struct Work;
  std::shared_ptr<Work> work_;
};

}  // namespace dmise
