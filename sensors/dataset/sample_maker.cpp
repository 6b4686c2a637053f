#include "sensors/dataset/sample_maker.h"

#include <algorithm>

#include "core/base/formatted.h"
#include "core/config/make_clock.h"
#include "core/dataset/npy.h"
#include "core/dataset/tar.h"
#include "core/image/fits_file.h"
#include "core/time/iso8601.h"
#include "orbit-node/load_objects.h"
#include "sensors/dataset/frame_labels.h"
#include "sensors/frame/make_sensor.h"
#include "sensors/frames/make_frames.h"

namespace dmise {
namespace {

/// Labels the frames of one sensor.
class SensorFrames {
 public:
  using Taker = std::function<void(const LabelledFrame&, const LabelImage&)>;

  SensorFrames(const DrawnScenario& sample, const Optics& grid, const Clock& clock,
               std::string digest, Taker taker)
      : sample_(sample),
        clock_(clock),
        digest_(std::move(digest)),
        taker_(std::move(taker)),
        plane_(grid.columns, grid.rows) {}

  void take(const Truth& truth, const ExpectedElectronImage& light, const ElectronImage& noise) {
    if (!objects_.empty() && objects_.front().truth.frame != truth.frame) clear();
    ObjectLabel label{truth, mask_of(light), optimal_snr(light, noise)};
    if (label.mask.empty()) return;
    plane_.add(objects_.size() + 1, label.mask, light);
    objects_.push_back(std::move(label));
  }

  void finish(const FrameProducts& frame) {
    if (!objects_.empty() && objects_.front().truth.frame != frame.report.frame) clear();
    const std::string key =
        formatted("%09llu-%s-%06u", static_cast<unsigned long long>(sample_.scenario.seed),
                  frame.report.sensor.c_str(), frame.report.frame);
    taker_({frame, objects_, sample_, clock_, digest_, key}, plane_.image());
    clear();
  }

 private:
  void clear() {
    objects_.clear();
    plane_ = LabelPlane(plane_.image().columns, plane_.image().rows);
  }

  const DrawnScenario& sample_;
  const Clock& clock_;
  std::string digest_;
  Taker taker_;
  std::vector<ObjectLabel> objects_;  // in the frame at hand
  LabelPlane plane_;
};

/// A frame as it goes into an archive.
SampleFrame members_of(const LabelledFrame& labelled, const LabelImage& mask) {
  const CountImage& counts = labelled.frame.counts;
  SampleFrame made{.key = labelled.key};
  const std::string image_name = made.key + ".image.npy";
  made.members = tar_member(image_name, npy_bytes(counts.pixels, counts.columns, counts.rows));
  made.members +=
      tar_member(made.key + ".mask.npy", npy_bytes(mask.pixels, counts.columns, counts.rows));
  made.members += tar_member(made.key + ".labels.json", labels_json(labelled));
  if (labelled.sample.scenario.output.fits)
    made.members += tar_member(made.key + ".fits", encode_frame(counts, labelled.frame.header));
  made.coco_image = coco_image(labelled, image_name);
  made.coco_annotations = coco_annotations(labelled);
  return made;
}

/// Names of a scenario's objects, platforms and targets, and files that objects are loaded from.
std::string names_in(const Scenario& scenario) {
  std::string names;
  const auto add = [&](const std::string& name) { names += name + "\n"; };
  add(scenario.earth_orientation_path);
  for (const ObjectSource& source : scenario.objects) {
    add(source.path);
    if (source.walker) add(source.named + " of " + std::to_string(source.walker->satellites()));
    if (source.breakup)  // what there is depends on the seed
      add(source.named + " by " + std::to_string(source.breakup->seed.value_or(scenario.seed)));
    if (source.population)
      add(source.named + " by " + std::to_string(source.population->seed.value_or(scenario.seed)));
    add(source.facts_path);
    for (const auto& name : source.only) add(name);
  }
  for (const OwnObject& object : scenario.own_objects)
    add(object.name + (object.attitude ? " turns " : " ") +
        std::to_string(object.catalogue_number));
  for (const SensorConfig& sensor : scenario.sensors) {
    if (const auto* platform = std::get_if<PlatformConfig>(&sensor.place)) add(platform->object);
    if (const auto* target = std::get_if<PointTarget>(&sensor.pointing)) add(target->object);
    add(std::holds_alternative<PointBody>(sensor.pointing) ? "body" : "");
  }
  return names;
}

/// Whether an object is described for a span of time alone.
bool has_spans(const Scenario& scenario) {
  return std::ranges::any_of(scenario.own_objects, [](const OwnObject& object) {
    return !object.motion.trajectory_path.empty() ||
           (object.attitude && !object.attitude->table_path.empty());
  });
}

}  // namespace

void SampleMaker::prepare(const Scenario& scenario) {
  refuse_own_nodes(scenario.own_nodes, "dmise dataset");
  auto& stars = stars_[{scenario.star_catalogue_path, scenario.star_variables_path}];
  if (!stars) stars = load_stars(scenario);
  if (checked_.insert(names_in(scenario)).second) {
    check_sensors(scenario, load_objects(scenario, make_clock(scenario)).roster);
  } else if (has_spans(scenario)) {
    Scenario own = scenario;  // without the catalogues, which take longer
    own.objects.clear();
    load_objects(own, Clock(parse_utc(own.start_utc)));
  }
}

void SampleMaker::make(const DrawnScenario& sample, const FrameTaker& take) {
  const Scenario& scenario = sample.scenario;
  prepare(scenario);
  const Clock clock = make_clock(scenario);
  std::vector<std::unique_ptr<SensorFrames>> labelling;
  std::vector<FrameTap> taps;
  for (std::size_t k = 0; k < scenario.sensors.size(); ++k) {
    const SensorConfig& sensor = scenario.sensors[k];
    labelling.push_back(std::make_unique<SensorFrames>(
        sample, sensor.camera.optics, clock, digest_,
        [k, &take](const LabelledFrame& frame, const LabelImage& mask) { take(k, frame, mask); }));
    SensorFrames* frames = labelling.back().get();
    const auto set_up = [frames](PipelineSettings& settings) {
      settings.output.noise = true;
      settings.object_light = [frames](const Truth& truth, const ExpectedElectronImage& light,
                                       const ElectronImage& noise) {
        frames->take(truth, light, noise);
      };
    };
    taps.push_back(
        {sensor.name, set_up, [frames](FrameProducts& frame) { frames->finish(frame); }});
  }
  Threads one(1);
  const auto& stars = stars_.at({scenario.star_catalogue_path, scenario.star_variables_path});
  make_frames(scenario, {load_objects(scenario, clock), stars}, digest_, taps, one);
}

std::vector<SampleFrame> SampleMaker::make(const DrawnScenario& sample) {
  std::vector<std::vector<SampleFrame>> of_sensor(sample.scenario.sensors.size());
  make(sample, [&](std::size_t sensor, const LabelledFrame& frame, const LabelImage& mask) {
    of_sensor[sensor].push_back(members_of(frame, mask));
  });
  std::vector<SampleFrame> frames;
  for (auto& made : of_sensor)
    for (SampleFrame& frame : made) frames.push_back(std::move(frame));
  return frames;
}

}  // namespace dmise
