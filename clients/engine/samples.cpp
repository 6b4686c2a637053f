#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "clients/engine/arrays.h"
#include "clients/engine/engine.h"
#include "clients/engine/interruptible.h"
#include "launch/dataset/dataset_digest.h"
#include "sensors/dataset/frame_labels.h"
#include "sensors/dataset/sample_maker.h"

namespace nb = nanobind;

namespace dmise {
namespace {

/// A frame of a sample as `dmise dataset` writes it.
struct Labelled {
  std::string key, labels;
  CountImage counts;
  LabelImage mask;
};

/// A scenario with distributions, and what its samples share. One sample is made at a time.
class Maker {
 public:
  explicit Maker(ScenarioDraws draws)
      : draws_(std::move(draws)), digest_(dataset_digest(draws_)), maker_(digest_) {}

  /// Frames by sensor and number.
  std::vector<Labelled> make(std::uint64_t seed) {
    const DrawnScenario sample = draws_.draw(seed);
    check_output_of_dataset(sample.scenario);
    std::vector<std::vector<Labelled>> of_sensor(sample.scenario.sensors.size());
    const std::lock_guard lock(mutex_);
    maker_.make(
        sample, [&](std::size_t sensor, const LabelledFrame& frame, const LabelImage& mask) {
          of_sensor[sensor].push_back({frame.key, labels_json(frame), frame.frame.counts, mask});
        });
    std::vector<Labelled> all;
    for (auto& frames : of_sensor)
      for (Labelled& frame : frames) all.push_back(std::move(frame));
    return all;
  }

 private:
  ScenarioDraws draws_;
  std::string digest_;
  std::mutex mutex_;
  SampleMaker maker_;
};

/// What Python holds: the work of a thread that was left keeps its maker.
struct Samples {
  std::shared_ptr<Maker> maker;
};

template <class Pixels>
nb::object array_from(Pixels image) {
  const std::size_t rows = std::size_t(image.rows), columns = std::size_t(image.columns);
  return array_of(std::move(image.pixels), {rows, columns});
}

nb::list samples_of(const Samples& samples, std::uint64_t seed) {
  auto frames = of_scenario([&] {
    return interruptible<std::vector<Labelled>>(
        [maker = samples.maker, seed] { return maker->make(seed); });
  });
  nb::list list;
  for (Labelled& frame : frames)
    list.append(nb::make_tuple(frame.key, array_from(std::move(frame.counts)),
                               array_from(std::move(frame.mask)), frame.labels));
  return list;
}

/// Reads what determines the samples, without the interpreter's lock.
template <class... Source>
Samples samples_from(const Source&... source) {
  const nb::gil_scoped_release without;
  return of_scenario([&] { return Samples{std::make_shared<Maker>(ScenarioDraws(source...))}; });
}

}  // namespace

void add_samples(nb::module_& module) {
  module.attr("max_sample_seed") = max_sample_seed;
  nb::class_<Samples>(module, "Samples")
      .def_static("of_file", &samples_from<std::string>)
      .def_static("of_text", &samples_from<std::string, std::string>)
      .def("make", &samples_of);
}

}  // namespace dmise
