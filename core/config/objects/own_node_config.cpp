#include "core/config/objects/own_node_config.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/files/text_fields.h"
#include "core/base/printable.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/trusted_directories.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

constexpr Tick longest_period_ticks = 100'000, longest_delay_ticks = 100'000;

Forms option_forms() { return Forms{{.kind = Form::Kind::number}} | form::flag() | form::text(); }

const Section& options_section() {
  static const Section section{"node_options",
                               "What the program is told as it begins: keys of its own.",
                               {},
                               optional("^.+$", option_forms() | form::list(option_forms()),
                                        "A number, a flag, a text, or a list of them.")};
  return section;
}

/// What an input of an FMU can be given: names that `dmise.fmi` of the Python package knows.
std::vector<std::string> fmu_sources() {
  std::vector<std::string> names{"time_s"};
  for (const std::string axis : {"x", "y", "z"}) {
    names.push_back("position_" + axis + "_m");
    names.push_back("velocity_" + axis + "_m_per_s");
    for (const std::string body : {"sun_", "moon_", "earth_"})
      for (const std::string frame : {"gcrs_", "body_"}) names.push_back(body + frame + axis);
  }
  return names;
}

const Section& fmu_inputs_section() {
  static const Section section{
      "fmu_inputs",
      "Input variables of an FMU, and what each is given at the beginning of a step.",
      {},
      optional("^.+$", form::choice(fmu_sources()),
               "Seconds since the start, a component of the object's own position or velocity, or "
               "of the direction of Sun, Moon or Earth from it, in axes of GCRS or of its body.")};
  return section;
}

const Section& fmu_outputs_section() {
  const auto names = [] { return form::list(form::text(), 1); };
  static const Section section{
      "fmu_outputs",
      "Output variables of an FMU that say where its object is.",
      {optional("position_m", names(), "x, y, z of the position in GCRS [m]."),
       optional("velocity_m_per_s", names(), "x, y, z of the velocity in GCRS [m/s]."),
       optional("gcrs_from_body", names(), "w, x, y, z of the attitude, a unit quaternion."),
       optional("rate_rad_per_s", names(), "x, y, z of the angular velocity in GCRS [rad/s].")}};
  return section;
}

const Section& own_node_section() {
  static const Section section{
      "node",
      "A program of one's own that takes part in the run.",
      {required("name", form::text(), "A unique name of letters, digits, - and _."),
       optional("run", form::list(form::text(), 1),
                "Program and arguments. It runs in the directory of the scenario, and only with "
                "`--allow-programs` or in a trusted directory."),
       optional("fmu", form::text(),
                "A Functional Mock-up Unit (FMI 2.0 or 3.0, co-simulation) that moves or turns one "
                "object. The Python package runs it, with FMPy, and only with "
                "`--allow-programs` or in a trusted directory."),
       optional("inputs", form::map(fmu_inputs_section), "What the FMU is given."),
       optional("outputs", form::map(fmu_outputs_section), "What the FMU says."),
       optional("elsewhere", form::flag(),
                "The program is started by whoever joins it, with `dmise join SCENARIO NAME "
                "--program`.",
                "off"),
       bound<&OwnNode::period_ticks>(
           "period_ticks", form::integer(1, longest_period_ticks),
           "Ticks between those for which the program is asked for states. Cubics join the "
           "others."),
       optional("consumes", form::list(form::text(), 1),
                "Topics that a node which moves or turns objects hears: `detection/SENSOR`, "
                "`frame/SENSOR`, `track/fusion-node`, `task/SENSOR` and, with states as they are, "
                "`state/actor/NODE`; `detection/*` is all that begin so."),
       bound<&OwnNode::delay_ticks>(
           "delay_ticks", form::integer(1, longest_delay_ticks),
           "Ticks after which it hears what is published on these topics."),
       optional(
           "options", form::map(options_section),
           "What the program is told as it begins; of an FMU the numbers with which its parameters "
           "and variables start.")}};
  return section;
}

/// A number or flag as YAML understands it unless it is quoted, else a text.
void write_scalar(JsonWriter& json, const YamlValue& value) {
  const std::string text = value.node().Scalar();
  const bool quoted = value.node().Tag() == "!";
  const auto number = quoted ? std::nullopt : parse_real(text);
  if (number)
    json.value(*number);
  else if (!quoted && (text == "on" || text == "true" || text == "yes"))
    json.value(true);
  else if (!quoted && (text == "off" || text == "false" || text == "no"))
    json.value(false);
  else
    json.value(text);
}

void write_option(JsonWriter& json, const YamlValue& value) {
  if (value.is_map()) value.fail("must be a number, a flag, a text, or a list of them", false);
  if (!value.is_list()) return write_scalar(json, value);
  json.begin_array();
  for (const YamlValue& item : value.list()) {
    if (!item.is_scalar()) item.fail("must be a number, a flag or a text", false);
    write_scalar(json, item);
  }
  json.end_array();
}

std::string read_options(const YamlValue& value) {
  YamlMap map(value, options_section());
  JsonWriter json;
  json.begin_object();
  for (const std::string& key : map.keys()) {
    json.key(key);
    write_option(json, map.require(key));
  }
  map.done();
  return json.end_object().take();
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Whether an argument is the name of a script, as people call theirs.
bool names_script(const std::string& word) {
  constexpr std::array endings{".py", ".sh", ".jl", ".js", ".jar", ".lua", ".m", ".pl", ".rb"};
  return !word.starts_with('-') &&
         std::ranges::any_of(endings, [&](const char* ending) { return word.ends_with(ending); });
}

std::vector<std::string> read_run(const YamlValue& run, const std::string& directory) {
  std::vector<std::string> words;
  for (const YamlValue& word : run.list()) {
    words.push_back(word.text());
    if (words.size() > 1 && names_script(words.back()) &&
        !is_file(fs::path(directory) / words.back()))
      word.fail("there is no such file in " + directory);
  }
  if (words.empty()) run.fail("needs a program", false);
  return words;
}

std::vector<std::string> read_fmu(const YamlValue& fmu, const std::string& directory) {
  if (!is_file(fs::path(directory) / fmu.text())) fmu.fail("there is no such file in " + directory);
  return {"python3", "-m", "dmise.fmi", fmu.text()};
}

void write_inputs(JsonWriter& json, const YamlValue& value) {
  YamlMap map(value, fmu_inputs_section());
  for (const std::string& name : map.keys()) json.field(name, map.require(name).choice());
  map.done();
}

void write_outputs(JsonWriter& json, const YamlValue& value, OwnNode& node) {
  node.fmu_outputs_where = value.place();
  YamlMap map(value, fmu_outputs_section());
  for (const auto& [key, count] :
       {std::pair("position_m", 3u), std::pair("velocity_m_per_s", 3u),
        std::pair("gcrs_from_body", 4u), std::pair("rate_rad_per_s", 3u)}) {
    const auto names = map.find(key);
    if (!names) continue;
    std::vector<std::string> variables;
    for (const YamlValue& name : names->list()) variables.push_back(name.text());
    if (variables.size() != count)
      names->fail("must be " + std::to_string(count) + " names of variables", false);
    json.list(key, variables);
    node.fmu_outputs.push_back(key);
  }
  map.done();
}

/// What `dmise.fmi` is told: the tables of the node, and its options.
std::string fmu_json(YamlMap& map, OwnNode& node) {
  JsonWriter json;
  json.begin_object().key("inputs").begin_object();
  if (const auto inputs = map.find("inputs")) write_inputs(json, *inputs);
  json.end_object().key("outputs").begin_object();
  write_outputs(json, map.require("outputs"), node);
  json.end_object().key("options").raw(node.options_json);
  return json.end_object().take();
}

void read_consumes(YamlMap& map, OwnNode& node) {
  const auto consumes = map.find("consumes");
  const auto delay = map.find("delay_ticks");
  if (!consumes) {
    if (delay) delay->fail("is of topics that the node consumes", false);
    return;
  }
  if (node.is_fmu) consumes->fail("an FMU hears no topics", false);
  if (node.period_ticks != 1)
    consumes->fail("needs period_ticks: 1, for it hears topics at each tick", false);
  for (const YamlValue& topic : consumes->list())
    node.hears.push_back({topic.text(), topic.place()});
}

OwnNode read_own_node(const YamlValue& value, OwnNodeModels models) {
  YamlMap map(value, own_node_section());
  OwnNode node{.where = value.place()};
  node.name = map.require("name").text();
  node.directory = fs::absolute(value.file()).parent_path().string();
  const auto run = map.find("run");
  const auto fmu = map.find("fmu");
  const bool elsewhere = map.flag("elsewhere");
  read_bound(map, node);
  if (const auto options = map.find("options")) node.options_json = read_options(*options);
  if (fmu) node.options_json = fmu_json(map, node);
  node.is_fmu = bool(fmu);
  read_consumes(map, node);
  map.done();
  node.is_function = models == OwnNodeModels::functions;
  if (node.is_function && fmu) fmu->fail("an FMU is no function of this process", false);
  if (node.is_function) return node;
  if (int(bool(run)) + int(bool(fmu)) + int(elsewhere) != 1)
    value.fail("give either run or fmu or elsewhere: on", false);
  if (elsewhere) return node;
  node.run_where = (run ? run : fmu)->place();
  node.run = run ? read_run(*run, node.directory) : read_fmu(*fmu, node.directory);
  if (!program_of(node).empty()) return node;
  if (run) run->list()[0].fail("there is no such program");
  fmu->fail("needs python3 on the PATH");
}

}  // namespace

Forms own_nodes_forms() { return form::list(form::map(own_node_section)); }

std::vector<OwnNode> read_own_nodes(const YamlValue& value, OwnNodeModels models) {
  std::vector<OwnNode> nodes;
  for (const YamlValue& entry : value.list()) nodes.push_back(read_own_node(entry, models));
  return nodes;
}

void write_own_nodes(JsonWriter& json, const std::vector<OwnNode>& nodes) {
  json.key("nodes").begin_array();
  for (const OwnNode& node : nodes) {
    json.begin_object().field("name", node.name).list("run", node.run);
    json.field("period_ticks", node.period_ticks).key("options").raw(node.options_json);
    if (!node.consumes.empty())
      json.list("consumes", node.consumes).field("delay_ticks", node.delay_ticks);
    json.end_object();
  }
  json.end_array();
}

std::string program_of(const OwnNode& node) {
  const fs::path program = node.run.front();
  const auto found = [](const fs::path& path) {
    return is_file(path) && access(path.c_str(), X_OK) == 0;
  };
  if (program.has_parent_path()) {
    const fs::path path = node.directory / program;
    return found(path) ? path.string() : "";
  }
  const char* search = std::getenv("PATH");
  std::istringstream directories(search ? search : "/usr/bin:/bin");
  for (std::string directory; std::getline(directories, directory, ':');)
    if (const fs::path path = fs::path(directory) / program; !directory.empty() && found(path))
      return path.string();
  return "";
}

std::vector<std::string> files_of(const std::vector<OwnNode>& nodes) {
  std::vector<std::string> files;
  for (const OwnNode& node : nodes)
    for (std::size_t i = 0; i < node.run.size(); ++i) {
      if (i == 0)
        files.push_back(program_of(node));
      else if (const fs::path path = fs::path(node.directory) / node.run[i]; is_file(path))
        files.push_back(path.string());
    }
  return files;
}

std::string command_text(const OwnNode& node) {
  std::string text;
  for (const std::string& word : node.run) text += (text.empty() ? "" : " ") + printable(word);
  return text;
}

void refuse_programs(const std::vector<OwnNode>& nodes) {
  const std::string list = trusted_directories_file();
  std::string where, programs, distrust;
  for (const OwnNode& node : nodes) {
    if (node.run.empty()) continue;
    const std::string why = list.empty() ? "" : why_not_trusted(node.directory, list);
    if (!list.empty() && why.empty()) continue;
    if (where.empty()) where = node.run_where;
    if (distrust.empty() && !why.empty()) distrust = "; " + why;
    programs += (programs.empty() ? "" : ", ") + ("`" + command_text(node) + "`");
  }
  if (!programs.empty())
    throw ConfigError(where + ": the scenario starts " + programs +
                      "; --allow-programs or a trusted directory permits it" + distrust);
}

void refuse_own_nodes(const std::vector<OwnNode>& nodes, const std::string& who) {
  if (!nodes.empty())
    throw ConfigError(nodes.front().where + ": " + who + " runs no nodes of one's own");
}

}  // namespace dmise
