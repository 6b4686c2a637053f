#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "clients/engine/arrays.h"
#include "clients/engine/engine.h"
#include "clients/engine/interruptible.h"
#include "clients/engine/like_frame.h"
#include "core/base/files/json.h"
#include "core/base/nearest_name.h"
#include "core/base/printable.h"
#include "core/config/make_clock.h"
#include "core/config/objects/own_node_config.h"
#include "core/config/own_node_roles.h"
#include "core/config/scenario_draws.h"
#include "core/config/yaml/distribution.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/image/charts/picture.h"
#include "core/image/fits_file.h"
#include "core/pictures/picture_file.h"
#include "core/plan/plan_json.h"
#include "core/products/product_json.h"
#include "core/time/iso8601.h"
#include "launch/run/run_directory.h"
#include "sensors/frames/frame_stream.h"
#include "sensors/scene/frame_times.h"

namespace nb = nanobind;

namespace dmise {
namespace {

/// Inputs of a scenario, read when the first stream asks for them and shared by all.
class SharedInputs {
 public:
  ScenarioInputs of(const Scenario& scenario) {
    std::lock_guard lock(mutex_);
    if (!inputs_) inputs_ = load_scene(scenario, make_clock(scenario));
    return *inputs_;
  }

 private:
  std::mutex mutex_;
  std::optional<ScenarioInputs> inputs_;
};

/// One frame, its clock and what is known of it.
class MadeFrame {
 public:
  MadeFrame(std::unique_ptr<StreamedFrame> made, std::shared_ptr<const Clock> clock)
      : made_(std::move(made)), clock_(std::move(clock)) {}

  const FrameProducts& products() const { return made_->products; }
  const StreamedFrame& made() const { return *made_; }

  std::vector<std::string> detections() const { return lines(products().detections); }
  std::vector<std::string> truths() const { return lines(products().truths); }
  std::string report() const { return line(products().report); }
  /// "{}" of a frame that was not planned.
  std::string plan() const {
    if (products().plan.planned.empty()) return "{}";
    JsonWriter json;
    write_plan(json, products().plan);
    return json.take();
  }
  std::vector<std::string> cards() const {
    return frame_file_cards(products().counts, products().header);
  }
  nb::bytes fits() const {
    std::string bytes;
    {
      nb::gil_scoped_release without;
      const FlagImage& flags = products().flags;
      bytes = encode_frame(products().counts, products().header,
                           flags.pixels.empty() ? nullptr : &flags);
    }
    return nb::bytes(bytes.data(), bytes.size());
  }
  /// The picture of a run, for display.
  nb::bytes png() const {
    std::string bytes;
    {
      nb::gil_scoped_release without;
      bytes = encode_picture(preview(products().counts).picture, "png");
    }
    return nb::bytes(bytes.data(), bytes.size());
  }
  bool has_layers() const { return !made_->objects.pixels.empty(); }

  /// Expected electrons of the sky, with Sun, Moon and Earth.
  std::vector<float> sky() const { return times_exposure(products().planes.background.pixels); }
  /// Expected electrons of stars: of all sources less those of objects.
  std::vector<float> stars() const {
    std::vector<float> light = times_exposure(products().planes.sources.pixels);
    for (std::size_t i = 0; i < light.size(); ++i)
      light[i] = std::max(0.0f, light[i] - made_->objects.pixels[i]);
    return light;
  }

 private:
  template <class Product>
  std::string line(const Product& product) const {
    return to_json(product, [this](SimTime t) { return format_utc(clock_->utc(t), 6); });
  }
  template <class Product>
  std::vector<std::string> lines(const std::vector<Product>& products) const {
    std::vector<std::string> texts;
    for (const Product& product : products) texts.push_back(line(product));
    return texts;
  }
  std::vector<float> times_exposure(std::vector<float> rates) const {
    for (float& rate : rates) rate = float(rate * products().header.exposure_s);
    return rates;
  }

  std::unique_ptr<StreamedFrame> made_;
  std::shared_ptr<const Clock> clock_;
};

/// Frames of a simulation, one at a time.
class Stream {
 public:
  Stream(StreamSource source, StreamOptions options, std::shared_ptr<const Clock> clock)
      : stream_(std::move(source), std::move(options)), clock_(std::move(clock)) {}

  /// Null after the last frame. `models` is called in this thread with the name of a node, that of
  /// the sensor for which it detects, or "", and the frames of a request, and returns those of the
  /// answer. What it raises ends the stream.
  std::unique_ptr<MadeFrame> next(nb::handle models) {
    stream_.ask();
    while (true) {
      wait_interruptibly([this](auto time) { return stream_.wait(time); },
                         [this] { stream_.stop(); });
      const auto request = stream_.request();
      if (!request) break;
      answer(*request, models);
    }
    auto made = of_scenario([this] { return stream_.take(); });
    return made ? std::make_unique<MadeFrame>(std::move(made), clock_) : nullptr;
  }
  void stop() { stream_.stop(); }
  std::vector<std::string> take_notes() { return stream_.take_notes(); }

 private:
  void answer(const ModelRequest& request, nb::handle models) {
    try {
      nb::list asked;
      for (const std::string& frame : request.frames)
        asked.append(nb::bytes(frame.data(), frame.size()));
      std::vector<std::string> frames;
      for (const nb::handle each : models(request.node, request.sensor, asked)) {
        const auto frame = nb::cast<nb::bytes>(each);
        frames.emplace_back(frame.c_str(), frame.size());
      }
      stream_.answer(std::move(frames));
    } catch (...) {
      stream_.stop();
      throw;
    }
  }

  FrameStream stream_;
  std::shared_ptr<const Clock> clock_;
};

using Names = std::set<std::string>;

/// Throws `ConfigError` for a node of the scenario that cannot be one of `models`, the functions of
/// this process, and for one of these that is no node of the scenario.
void check_own_nodes(const Scenario& scenario, const Names& models) {
  std::vector<std::string> names;
  for (const OwnNode& node : scenario.own_nodes) {
    names.push_back(node.name);
    const auto refuse = [&](const std::string& why) {
      throw ConfigError(node.where + ": " + why + "; dmise run and dmise launch can");
    };
    if (node.role == OwnNodeRole::sensor || node.role == OwnNodeRole::tracker)
      refuse("the engine in Python runs no sensors and trackers of one's own");
    if (!node.consumes.empty()) refuse("the engine in Python lets no model hear topics");
    if (!models.contains(node.name))
      throw ConfigError(node.where + ": its model is not given: dmise.Simulation(.., nodes={\"" +
                        node.name + "\": ..})");
  }
  for (const std::string& name : models)
    if (std::ranges::count(names, name) == 0)
      throw ConfigError(scenario.path + ": nodes: no node has this name" +
                        did_you_mean(name, names) + ", got " + printable(name));
}

/// The names of the objects that a node moves or turns, in the scenario's order.
std::vector<std::string> objects_of(const Scenario& scenario, const OwnNode& node) {
  std::vector<std::string> names;
  for (const OwnObject& object : scenario.own_objects)
    if (is_moved_by(node, object) || is_turned_by(node, object)) names.push_back(object.name);
  return names;
}

class Simulation {
 public:
  explicit Simulation(Scenario scenario, const Names& models = {}) {
    check_own_nodes(scenario, models);
    scenario.network.publish_states = false;  // as of a run in one process
    scenario_ = std::make_shared<const Scenario>(std::move(scenario));
    clock_ = std::make_shared<const Clock>(make_clock(*scenario_));
  }
  static std::unique_ptr<Simulation> of(const YamlValue& root, std::optional<std::uint64_t> seed,
                                        const std::vector<std::string>& nodes) {
    refuse_distributions(root, "dmise dataset draws a value for each seed");
    const Names models(nodes.begin(), nodes.end());
    Scenario scenario = read_scenario(root, OwnNodeModels::functions);
    if (seed) scenario.seed = *seed;
    return std::make_unique<Simulation>(std::move(scenario), models);
  }
  /// With values drawn for the seed.
  static std::unique_ptr<Simulation> drawn(const ScenarioDraws& draws, std::uint64_t seed) {
    const DrawnScenario drawn = draws.draw(seed);
    refuse_own_nodes(drawn.scenario.own_nodes, "an injection");
    return std::make_unique<Simulation>(drawn.scenario);
  }
  std::unique_ptr<Simulation> like(const Likeness& frame) const {
    return std::make_unique<Simulation>(like_frame(*scenario_, frame));
  }

  const Scenario& scenario() const { return *scenario_; }

  std::unique_ptr<Stream> frames(const std::vector<std::string>& sensors, int threads,
                                 bool layers) {
    StreamOptions options{
        .sensors = sensors, .threads = checked_threads(threads), .layers = layers};
    if (sensors.empty())
      for (const auto& sensor : scenario_->sensors) options.sensors.push_back(sensor.name);
    for (const auto& sensor : sensors) sensor_named(*scenario_, sensor);
    StreamSource source{
        .scenario = scenario_,
        .scene = [inputs = inputs_, scenario = scenario_] { return inputs->of(*scenario); },
        .digest = digest()};
    return std::make_unique<Stream>(std::move(source), std::move(options), clock_);
  }

  std::string digest() {
    if (digest_.empty()) digest_ = scenario_digest(*scenario_);
    return digest_;
  }

  std::vector<std::string> sensors() const {
    std::vector<std::string> names;
    for (const auto& sensor : scenario_->sensors) names.push_back(sensor.name);
    return names;
  }
  std::uint32_t count_of(const std::string& sensor) const {
    return frames_within(sensor_named(*scenario_, sensor), scenario_->duration);
  }
  /// Name, place in the file, role (a mark of the package) and objects of each node of the user's.
  nb::list own_nodes() const {
    nb::list nodes;
    for (const OwnNode& node : scenario_->own_nodes)
      nodes.append(nb::make_tuple(node.name, node.where,
                                  node.role == OwnNodeRole::actor ? "actor" : "detector",
                                  objects_of(*scenario_, node)));
    return nodes;
  }
  std::string start_utc() const { return format_utc(clock_->utc({0}), 6); }

 private:
  std::shared_ptr<const Scenario> scenario_;
  std::shared_ptr<const Clock> clock_;
  std::shared_ptr<SharedInputs> inputs_ = std::make_shared<SharedInputs>();
  std::string digest_;
};

template <class Member>
auto text_of(Member member) {
  return [member](const MadeFrame& frame) { return frame.products().report.*member; };
}

nb::object image_of(nb::handle_t<MadeFrame> self, const auto& image) {
  return array_in(image.pixels.data(), {std::size_t(image.rows), std::size_t(image.columns)}, self);
}

nb::object layer_of(const MadeFrame& frame, std::vector<float> light) {
  const CountImage& counts = frame.products().counts;
  return array_of(std::move(light), {std::size_t(counts.rows), std::size_t(counts.columns)});
}

void add_frame(nb::module_& module) {
  nb::class_<MadeFrame>(module, "Frame")
      .def_prop_ro("sensor", text_of(&FrameReport::sensor))
      .def_prop_ro("number", text_of(&FrameReport::frame))
      .def_prop_ro("has_layers", &MadeFrame::has_layers)
      .def("counts",
           [](nb::handle_t<MadeFrame> self) {
             return image_of(self, nb::cast<const MadeFrame&>(self).products().counts);
           })
      .def("labels",
           [](nb::handle_t<MadeFrame> self) {
             return image_of(self, nb::cast<const MadeFrame&>(self).made().labels);
           })
      .def("objects",
           [](nb::handle_t<MadeFrame> self) {
             return image_of(self, nb::cast<const MadeFrame&>(self).made().objects);
           })
      .def("sky", [](const MadeFrame& frame) { return layer_of(frame, frame.sky()); })
      .def("stars", [](const MadeFrame& frame) { return layer_of(frame, frame.stars()); })
      .def("cards", &MadeFrame::cards)
      .def_prop_ro("wcs", [](const MadeFrame& frame) { return frame.products().header.wcs; })
      .def_prop_ro("psf_fwhm_px",
                   [](const MadeFrame& frame) { return frame.products().header.psf_fwhm_px; })
      .def_prop_ro(
          "zero_point_mag",
          [](const MadeFrame& frame) { return frame.products().header.v_solar_zero_point_mag(); })
      .def("fits", &MadeFrame::fits)
      .def("png", &MadeFrame::png)
      .def("detections", &MadeFrame::detections)
      .def("truths", &MadeFrame::truths)
      .def("report", &MadeFrame::report)
      .def("plan", &MadeFrame::plan);
}

}  // namespace

void add_simulation(nb::module_& module) {
  add_frame(module);
  nb::class_<Likeness>(module, "Likeness")
      .def(nb::init<>())
      .def_rw("sensor", &Likeness::sensor)
      .def_rw("start_utc", &Likeness::start_utc)
      .def_rw("exposure_s", &Likeness::exposure_s)
      .def_rw("columns", &Likeness::columns)
      .def_rw("rows", &Likeness::rows)
      .def_rw("focal_length_px", &Likeness::focal_length_px)
      .def_rw("ra_deg", &Likeness::ra_deg)
      .def_rw("dec_deg", &Likeness::dec_deg)
      .def_rw("roll_deg", &Likeness::roll_deg)
      .def_rw("psf_fwhm_px", &Likeness::psf_fwhm_px)
      .def_rw("sidereal", &Likeness::sidereal)
      .def_rw("guided", &Likeness::guided)
      .def_rw("extinction", &Likeness::extinction);
  nb::class_<Stream>(module, "Stream", nb::is_weak_referenceable())
      .def("next", &Stream::next, nb::arg("models") = nb::none())
      .def("take_notes", &Stream::take_notes)
      .def("stop", &Stream::stop);
  nb::class_<Simulation>(module, "Simulation")
      .def_static(
          "of_file",
          [](const std::string& path, std::optional<std::uint64_t> seed,
             const std::vector<std::string>& nodes) {
            return of_scenario([&] { return Simulation::of(YamlValue::load(path), seed, nodes); });
          })
      .def_static("of_text",
                  [](const std::string& text, const std::string& name,
                     std::optional<std::uint64_t> seed, const std::vector<std::string>& nodes) {
                    return of_scenario(
                        [&] { return Simulation::of(YamlValue::parse(text, name), seed, nodes); });
                  })
      .def_static(
          "drawn_of_file",
          [](const std::string& path, std::uint64_t seed) {
            return of_scenario([&] { return Simulation::drawn(ScenarioDraws(path), seed); });
          })
      .def_static(
          "drawn_of_text",
          [](const std::string& text, const std::string& name, std::uint64_t seed) {
            return of_scenario([&] { return Simulation::drawn(ScenarioDraws(text, name), seed); });
          })
      .def("like",
           [](const Simulation& simulation, const Likeness& frame) {
             return of_scenario([&] { return simulation.like(frame); });
           })
      .def("frames",
           [](Simulation& simulation, const std::vector<std::string>& sensors, int threads,
              bool layers) {
             return of_scenario([&] { return simulation.frames(sensors, threads, layers); });
           })
      .def_prop_ro("sensors", &Simulation::sensors)
      .def_prop_ro("own_nodes", &Simulation::own_nodes)
      .def("count_of", &Simulation::count_of)
      .def_prop_ro("digest", &Simulation::digest)
      .def_prop_ro("start_utc", &Simulation::start_utc)
      .def_prop_ro("duration_s",
                   [](const Simulation& s) { return s.scenario().duration.seconds(); })
      .def_prop_ro("seed", [](const Simulation& s) { return s.scenario().seed; })
      .def_prop_ro("warnings", [](const Simulation& s) { return s.scenario().warnings; });
}

}  // namespace dmise
