#include "sensors/frames/frame_stream.h"

#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <utility>

#include "core/base/cancellation.h"
#include "core/base/detached_work.h"
#include "core/base/error.h"

namespace dmise {
namespace {

/// Collects the light of a frame's objects.
class ObjectLights {
 public:
  explicit ObjectLights(const Optics& grid)
      : light_(grid.columns, grid.rows), labels_(grid.columns, grid.rows) {}

  void take(const ExpectedElectronImage& light) {
    for (std::size_t i = 0; i < light.pixels.size(); ++i) light_.pixels[i] += light.pixels[i];
    labels_.add(++count_, mask_of(light), light);
  }

  /// Moves what was collected into `frame`, whose truths with light it was.
  void move_to(StreamedFrame& frame) {
    std::vector<std::uint16_t> number{0};  // among all truths, by that among those with light
    const auto& truths = frame.products.truths;
    for (std::size_t k = 0; k < truths.size(); ++k)
      if (truths[k].in_frame) number.push_back(std::uint16_t(k + 1));
    const int columns = light_.columns, rows = light_.rows;
    frame.labels = labels_.image();
    for (std::uint16_t& label : frame.labels.pixels) label = number.at(label);
    frame.objects = std::exchange(light_, ExpectedElectronImage(columns, rows));
    labels_ = LabelPlane(columns, rows);
    count_ = 0;
  }

 private:
  ExpectedElectronImage light_;
  LabelPlane labels_;
  std::size_t count_ = 0;
};

}  // namespace

/// What a stream and its thread share.
struct FrameStream::Work {
  StreamSource source;
  StreamOptions options;
  pid_t process = ::getpid();
  std::atomic<bool> stopped = false;
  std::mutex mutex;  // guards what follows
  std::condition_variable changed;
  bool asked = false, over = false;
  const FunctionRequest* request = nullptr;
  std::optional<std::vector<std::string>> answer;
  std::vector<std::string> notes;
  std::unique_ptr<StreamedFrame> frame;
  std::exception_ptr failure;

  void wait_until_asked() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return asked || stopped; });
    if (stopped) throw Cancelled();
  }

  void hand_over(std::unique_ptr<StreamedFrame> made) {
    {
      std::lock_guard lock(mutex);
      frame = std::move(made);
      asked = false;
      changed.notify_all();
    }
    wait_until_asked();
  }

  /// Has the thread that waits for a frame ask a model.
  std::vector<std::string> ask_model(const FunctionRequest& asked) {
    std::unique_lock lock(mutex);
    request = &asked;
    changed.notify_all();
    changed.wait(lock, [&] { return answer || stopped; });
    request = nullptr;
    if (!answer) throw Cancelled();
    return *std::exchange(answer, std::nullopt);
  }

  OwnNodeSettings models() {
    const auto function = [this](const FunctionRequest& asked) { return ask_model(asked); };
    return {.start = functions_in_process(function), .note = [this](const std::string& line) {
              std::lock_guard lock(mutex);
              notes.push_back(line);
            }};
  }

  FrameTap tap(const std::string& sensor) {
    auto lights =
        options.layers
            ? std::make_shared<ObjectLights>(sensor_named(*source.scenario, sensor).camera.optics)
            : nullptr;
    FrameTap tap{.sensor = sensor};
    tap.set_up = [this, lights](PipelineSettings& settings) {
      settings.output.saturation = source.scenario->output.saturation;
      if (!lights) return;
      settings.output.sources = settings.output.background = settings.output.noise = true;
      settings.object_light = [lights](const Truth&, const ExpectedElectronImage& light,
                                       const ElectronImage&) { lights->take(light); };
    };
    tap.made = [this, lights](FrameProducts& products) {
      auto made = std::make_unique<StreamedFrame>();
      made->products = std::move(products);
      if (lights) lights->move_to(*made);
      hand_over(std::move(made));
    };
    return tap;
  }

  void make_all() {
    wait_until_asked();
    CancellationScope scope(stopped);
    Threads threads(options.threads);
    std::vector<FrameTap> taps;
    for (const std::string& sensor : options.sensors) taps.push_back(tap(sensor));
    make_frames(*source.scenario, source.scene(), source.digest, taps, threads, models());
  }

  void run() {
    std::exception_ptr thrown;
    try {
      make_all();
    } catch (const Cancelled&) {
    } catch (...) {
      thrown = std::current_exception();
    }
    std::lock_guard lock(mutex);
    failure = thrown;
    over = true;
    changed.notify_all();
  }
};

FrameStream::FrameStream(StreamSource source, StreamOptions options)
    : work_(std::make_shared<Work>()) {
  work_->source = std::move(source);
  work_->options = std::move(options);
  start_detached([work = work_] { work->run(); });
}

FrameStream::~FrameStream() { stop(); }

void FrameStream::ask() {
  if (work_->process != ::getpid())
    throw Error("frames: this process was forked after they were begun; begin them again in it");
  std::lock_guard lock(work_->mutex);
  work_->asked = true;
  work_->changed.notify_all();
}

bool FrameStream::wait(std::chrono::milliseconds time) {
  std::unique_lock lock(work_->mutex);
  return work_->changed.wait_for(lock, time,
                                 [this] { return work_->request || work_->frame || work_->over; });
}

std::optional<ModelRequest> FrameStream::request() const {
  std::lock_guard lock(work_->mutex);
  if (!work_->request || work_->stopped) return std::nullopt;
  const FunctionRequest& asked = *work_->request;
  return ModelRequest{.node = std::string(asked.node),
                      .sensor = std::string(asked.sensor),
                      .frames = {asked.frames.begin(), asked.frames.end()}};
}

void FrameStream::answer(std::vector<std::string> frames) {
  std::lock_guard lock(work_->mutex);
  work_->request = nullptr;
  work_->answer = std::move(frames);
  work_->changed.notify_all();
}

std::vector<std::string> FrameStream::take_notes() {
  std::lock_guard lock(work_->mutex);
  return std::exchange(work_->notes, {});
}

std::unique_ptr<StreamedFrame> FrameStream::take() {
  std::lock_guard lock(work_->mutex);
  if (work_->frame) return std::move(work_->frame);
  if (auto failure = std::exchange(work_->failure, nullptr)) std::rethrow_exception(failure);
  return nullptr;
}

void FrameStream::stop() {
  if (work_->process != ::getpid()) return;
  std::lock_guard lock(work_->mutex);
  work_->stopped = true;
  work_->changed.notify_all();
}

}  // namespace dmise
