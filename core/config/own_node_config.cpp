#include "core/config/own_node_config.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/printable.h"
#include "core/base/text_fields.h"
#include "core/config/yaml_reader.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

constexpr Tick longest_period_ticks = 100'000;

Forms option_forms() { return Forms{{.kind = Form::Kind::number}} | form::flag() | form::text(); }

const Section& options_section() {
  static const Section section{"node_options",
                               "What the program is told as it begins: keys of its own.",
                               {},
                               optional("^.+$", option_forms() | form::list(option_forms()),
                                        "A number, a flag, a text, or a list of them.")};
  return section;
}

const Section& own_node_section() {
  static const Section section{
      "node",
      "A program of one's own that takes part in the run.",
      {required("name", form::text(), "A unique name of letters, digits, - and _."),
       optional("run", form::list(form::text(), 1),
                "Program and arguments. It runs in the directory of the scenario, and only with "
                "`--allow-programs`."),
       optional("elsewhere", form::flag(),
                "The program is started by whoever joins it, with `dmise join SCENARIO NAME "
                "--program`.",
                "off"),
       optional("period_ticks", form::integer(1, longest_period_ticks),
                "Ticks between those for which the program is asked for states. Cubics join the "
                "others.",
                "1"),
       optional("options", form::map(options_section), "What the program is told as it begins.")}};
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

OwnNode read_own_node(const YamlValue& value) {
  YamlMap map(value, own_node_section());
  OwnNode node{.where = value.place()};
  node.name = map.require("name").text();
  node.directory = fs::absolute(value.file()).parent_path().string();
  const auto run = map.find("run");
  const bool elsewhere = map.flag_or("elsewhere", false);
  node.period_ticks = map.integer_or("period_ticks", 1);
  if (const auto options = map.find("options")) node.options_json = read_options(*options);
  map.done();
  if (bool(run) == elsewhere) value.fail("give either run or elsewhere: on", false);
  if (run) {
    node.run_where = run->place();
    node.run = read_run(*run, node.directory);
    if (program_of(node).empty()) run->list()[0].fail("there is no such program");
  }
  return node;
}

}  // namespace

Forms own_nodes_forms() { return form::list(form::map(own_node_section)); }

std::vector<OwnNode> read_own_nodes(const YamlValue& value) {
  std::vector<OwnNode> nodes;
  for (const YamlValue& entry : value.list()) nodes.push_back(read_own_node(entry));
  return nodes;
}

void write_own_nodes(JsonWriter& json, const std::vector<OwnNode>& nodes) {
  json.key("nodes").begin_array();
  for (const OwnNode& node : nodes) {
    json.begin_object().field("name", node.name).list("run", node.run);
    json.field("period_ticks", node.period_ticks).key("options").raw(node.options_json);
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
  std::string where, programs;
  for (const OwnNode& node : nodes) {
    if (node.run.empty()) continue;
    if (where.empty()) where = node.run_where;
    programs += (programs.empty() ? "" : ", ") + ("`" + command_text(node) + "`");
  }
  if (!programs.empty())
    throw ConfigError(where + ": the scenario starts " + programs +
                      "; --allow-programs permits it");
}

void refuse_own_nodes(const std::vector<OwnNode>& nodes, const std::string& who) {
  if (!nodes.empty())
    throw ConfigError(nodes.front().where + ": " + who + " runs no nodes of one's own");
}

}  // namespace dmise
