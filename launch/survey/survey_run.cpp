#include "launch/survey/survey_run.h"

#include <algorithm>
#include <cstdio>
#include <memory>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/whole_file.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/base/version.h"
#include "core/config/make_clock.h"
#include "core/time/iso8601.h"
#include "launch/command/notes.h"
#include "launch/run/progress.h"
#include "launch/run/run_directory.h"
#include "launch/survey/survey_map.h"
#include "launch/survey/survey_report.h"
#include "orbit-node/load_objects.h"
#include "sensors/frame/make_sensor.h"
#include "sensors/survey/survey_file.h"

namespace dmise {
namespace {

constexpr double max_choice_bytes = 4e9;

/// K of "sites=K"; 0 without the option. `sites`: candidates.
std::size_t wanted_sites(const std::string& text, std::size_t sites) {
  if (text.empty()) return 0;
  constexpr std::string_view key = "sites=";
  const std::size_t count =
      text.starts_with(key) ? parse_count(text.substr(key.size())).value_or(0) : 0;
  if (count < 1 || count > sites)
    throw ConfigError("--optimise: must be sites=K, K in 1.." + std::to_string(sites) +
                      ", the places of the scenario's sensors on the ground, got " +
                      printable(text));
  return count;
}

void check_shells(const std::vector<double>& limits_km) {
  if (limits_km.size() > 32) throw ConfigError("--shells: at most 32 limits");
  for (std::size_t k = 0; k < limits_km.size(); ++k)
    if (!(limits_km[k] > (k > 0 ? limits_km[k - 1] : 0.0)))
      throw ConfigError("--shells: must be above 0 and ascend");
}

/// Everything that the survey of one sensor depends on, in one line.
std::string head_of(const Scenario& scenario, const SensorConfig& sensor,
                    const SurveyCommand& command, const DetectionModel& model) {
  Scenario one = scenario;
  one.sensors = {sensor};
  one.fusion.reset();
  std::string head = software_name() + " survey " + scenario_digest(one);
  const auto add = [&](double value) { head += formatted(" %.17g", value); };
  add(command.night_deg);
  add(sensor.mask_deg);
  for (const double km : command.shells_km) add(km);
  for (const double* share : model.shares()) add(*share);
  for (const auto* nodes : model.nodes())
    for (const auto& node : *nodes) {
      add(node.px);
      add(node.half_snr);
      add(node.spread);
    }
  return head;
}

/// Marks of the surveyed sites.
std::vector<MapMark> marks_of(const std::vector<SensorConfig>& sensors) {
  std::vector<MapMark> marks;
  for (const SensorConfig& sensor : sensors)
    if (const auto* site = std::get_if<SiteConfig>(&sensor.place))
      marks.push_back({site->latitude_deg, site->longitude_deg});
  return marks;
}

Scenario cameras_of(const std::string& path) {
  Scenario scenario = load_scenario(path);
  keep_cameras(scenario, "dmise survey");
  return scenario;
}

/// One survey, from files of an earlier call or from its sensors, to its products.
class Survey {
 public:
  explicit Survey(const SurveyCommand& command)
      : command_(command),
        scenario_(cameras_of(command.scenario)),
        clock_(make_clock(scenario_)),
        population_(load_objects(scenario_, clock_)),
        candidates_(candidate_sites(scenario_.sensors)),
        sites_(wanted_sites(command.optimise, candidates_.size())),
        nights_(nights_of(scenario_.duration)),
        shells_(shells_of(population_, command.shells_km)),
        threads_(command.threads),
        options_{.night_below_rad = command.night_deg * deg} {
    if (sites_ > 0 &&
        8.0 * double(candidates_.size()) * nights_ * double(population_.roster.objects.size()) >
            max_choice_bytes)
      throw ConfigError(
          "--optimise: sites x nights x objects are too many: use a shorter "
          "duration_s");
    check_sensors(scenario_, population_.roster);
    for (const auto& note : population_.notes) notes_.push_back(note);
    if (population_.roster.objects.empty()) notes_.push_back("the scenario has no objects");
    lock_ = lock_directory(command.out);
  }

  void run() {
    const auto stars = load_stars(scenario_);
    DetectionModel model = measured_detection_model();
    if (command_.fit > 0) model = fitted(stars);
    const SurveyScene scene(scenario_, population_, clock_, stars, threads_, model);
    survey_all(scene);
    SurveyReport report{.scenario = scenario_,
                        .clock = clock_,
                        .shells = shells_,
                        .surveys = surveys_,
                        .summary = summary_of(surveys_, scenario_.sensors),
                        .night_below_rad = options_.night_below_rad,
                        .model = model};
    if (sites_ > 0) report.chosen = chosen();
    if (command_.check > 0) {
      report.check = rendered(scene, command_.check, FrameHalf::even, "comparing with frames");
      write_file_whole(command_.out + "/check.csv", check_csv(*report.check));
    }
    progress_.clear_line();
    write_products(report);
    print_notes();
    if (command_.json)
      std::fputs(survey_json(report).c_str(), stdout);
    else
      std::printf("%s-> %s/survey.json, map.svg\n", survey_text(report).c_str(),
                  command_.out.c_str());
  }

 private:
  RenderedCheck rendered(const SurveyScene& scene, std::size_t frames, FrameHalf half,
                         const std::string& what) {
    SurveyOptions options = options_;
    options.progress = [&](double share) { progress_.show_share(share, "survey: " + what); };
    return check_rendered(scene, frames, half, threads_, options);
  }

  DetectionModel fitted(const std::shared_ptr<const StarMap>& stars) {
    const SurveyScene scene(scenario_, population_, clock_, stars, threads_);
    const RenderedCheck frames =
        rendered(scene, command_.fit, FrameHalf::odd, "measuring detection in frames");
    write_file_whole(command_.out + "/fit.csv", check_csv(frames));
    return fitted_detection_model(scene.model(), samples_of(frames));
  }

  void survey_all(const SurveyScene& scene) {
    const std::size_t count = scenario_.sensors.size();
    std::size_t known = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const SensorConfig& sensor = scenario_.sensors[k];
      const std::string head = head_of(scenario_, sensor, command_, scene.model());
      const std::string directory = command_.out + "/" + sensor.name;
      bool damaged = false;
      auto survey =
          read_survey(directory, head, sensor.name, population_.roster.objects.size(), damaged);
      if (damaged)
        notes_.push_back(sensor.name +
                         ": files of its survey are damaged or incomplete: it is surveyed again");
      if (survey) {
        ++known;
      } else {
        options_.progress = [&](double share) {
          progress_.show_share((double(k) + share) / double(count), "survey: " + sensor.name);
        };
        survey = survey_sensor(scene, sensor, shells_, threads_, options_);
        write_survey(directory, head, *survey, scene, shells_);
      }
      note_gaps(*survey, sensor);
      surveys_.push_back(std::move(*survey));
    }
    if (known > 0)
      notes_.push_back("surveys of " + std::to_string(known) + " of " + counted(count, "sensor") +
                       " were there");
  }

  void note_gaps(const SensorSurvey& survey, const SensorConfig& sensor) {
    if (survey.exposures.empty() && survey.without_state == 0)
      notes_.push_back(sensor.name + ": no exposure" +
                       (std::holds_alternative<SiteConfig>(sensor.place) && survey.frames > 0
                            ? formatted(" while the Sun is below %g deg", command_.night_deg)
                            : " ends within the run"));
    if (survey.without_state > 0)
      notes_.push_back(sensor.name + ": in " + std::to_string(survey.without_state) + " of " +
                       std::to_string(survey.frames) +
                       " exposures its platform or target has no state");
    if (survey.closed > 0)
      notes_.push_back(sensor.name + ": in " + std::to_string(survey.closed) + " of " +
                       std::to_string(survey.exposures.size()) +
                       " exposures its shutter is closed: a body is nearer to the axis than "
                       "camera.exclusion allows");
  }

  SurveySummary summary_of(const std::vector<SensorSurvey>& surveys,
                           const std::vector<SensorConfig>& sensors) const {
    std::vector<double> cadence_s;
    for (const auto& sensor : sensors) cadence_s.push_back(sensor.cadence_s);
    return summarise_survey(surveys, shells_, cadence_s, nights_);
  }

  ChosenNetwork chosen() const {
    const std::size_t objects = population_.roster.objects.size();
    ChosenNetwork network{
        .choice = choose_sites(misses_of(surveys_, candidates_, objects, nights_), sites_),
        .candidates = candidates_,
        .summary = {}};
    std::vector<bool> taken(surveys_.size(), true);
    for (std::size_t s = 0; s < candidates_.size(); ++s) {
      const auto& sites = network.choice.sites;
      if (std::find(sites.begin(), sites.end(), s) == sites.end())
        for (const std::size_t k : candidates_[s].sensors) taken[k] = false;
    }
    std::vector<SensorSurvey> surveys;
    std::vector<SensorConfig> sensors;
    for (std::size_t k = 0; k < surveys_.size(); ++k)
      if (taken[k]) {
        surveys.push_back(surveys_[k]);
        sensors.push_back(scenario_.sensors[k]);
      }
    network.summary = summary_of(surveys, sensors);
    return network;
  }

  void write_products(const SurveyReport& report) const {
    write_file_whole(command_.out + "/survey.json", survey_json(report));
    SurveyMap map{.title = "Where objects are detected",
                  .subtitle = format_utc(clock_.utc({0}), 0) + " to " +
                              format_utc(clock_.utc(scenario_.duration), 0) + ", " +
                              counted(surveys_.size(), "sensor") + ", " +
                              counted(shells_.of_object.size(), "object"),
                  .shells = shells_.shells,
                  .summaries = report.summary.run.shells,
                  .cells = {},
                  .sites = marks_of(scenario_.sensors)};
    for (const SensorSurvey& survey : surveys_)
      for (const auto& [key, cell] : survey.map) {
        MapCell& sum = map.cells[key];
        sum.looks += cell.looks;
        sum.expected += cell.expected;
      }
    write_file_whole(command_.out + "/map.svg", map_svg(map));
  }

  void print_notes() const {
    constexpr std::size_t most = 8;
    for (std::size_t k = 0; k < std::min(most, notes_.size()); ++k) print_note(notes_[k]);
    if (notes_.size() > most) print_note("and " + std::to_string(notes_.size() - most) + " more");
  }

  const SurveyCommand& command_;
  Scenario scenario_;
  Clock clock_;
  ObjectPopulation population_;
  std::vector<CandidateSite> candidates_;
  std::size_t sites_;
  int nights_;
  Shells shells_;
  Threads threads_;
  SurveyOptions options_;
  std::unique_ptr<RunLock> lock_;
  std::vector<SensorSurvey> surveys_;
  std::vector<std::string> notes_;
  Progress progress_;
};

}  // namespace

void run_survey(const SurveyCommand& command) {
  check_shells(command.shells_km);
  Survey(command).run();
}

}  // namespace dmise
